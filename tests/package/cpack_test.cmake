# Makes the packages and looks into them. Called by ctest with the variables that CMakeLists.txt beside this file names.

cmake_policy(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/checks.cmake)

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
foreach(kind DEB TGZ)
    run(0 ${CMAKE_COMMAND} -E chdir ${BUILD} ${CPACK} -G ${kind} -C ${CONFIG} -B ${WORK})
endforeach()

# The Debian package: what it says of itself, and all that a desktop needs.
file(GLOB package ${WORK}/curvewright_${VERSION}*.deb)
run(0 ${DPKG_DEB} --info ${package})
expect("${output}" "Package: curvewright\n")
expect("${output}" "Depends: [^\n]*qt6-qpa-plugins[^\n]*libqt6widgets6[^\n]*libvtk9")
run(0 ${DPKG_DEB} --extract ${package} ${WORK}/root)
foreach(file bin/curvewright bin/curvewright-cli libexec/curvewright/curvewright-vtk-reader share/man/man1/curvewright.1.gz share/man/man1/curvewright-cli.1.gz
             share/applications/curvewright.desktop share/mime/packages/curvewright.xml
             share/icons/hicolor/scalable/apps/curvewright.svg share/doc/curvewright/copyright
             share/curvewright/sample_meshes/MANIFEST share/curvewright/sample_meshes/annulus/annulus.msh)
    if(NOT EXISTS ${WORK}/root/usr/${file})
        message(FATAL_ERROR "The package has no /usr/${file}.")
    endif()
endforeach()
run(0 ${CMAKE_COMMAND} -E env --unset=DISPLAY ${WORK}/root/usr/bin/curvewright-cli quality ${SAMPLE} --json)
expect("${output}" "\"invalid\": 0")
# A VTK file is read by the program in libexec, wherever the package lies.
set(cli ${WORK}/root/usr/bin/curvewright-cli)
run(0 ${cli} convert ${SAMPLE} ${WORK}/sample.vtu)
run(0 ${cli} quality ${WORK}/sample.vtu --json)
expect("${output}" "\"invalid\": 0")
file(RENAME ${WORK}/root/usr/libexec ${WORK}/root/usr/elsewhere)
run(1 ${cli} quality ${WORK}/sample.vtu)
expect("${errors}" "sample\\.vtu: [^\n]*curvewright-vtk-reader[^\n]*\\.\n$")
file(RENAME ${WORK}/root/usr/elsewhere ${WORK}/root/usr/libexec)
# The types of files that the desktop entry names are those that the other file describes.
file(READ ${WORK}/root/usr/share/applications/curvewright.desktop entry)
file(READ ${WORK}/root/usr/share/mime/packages/curvewright.xml types)
string(REGEX MATCH "MimeType=([^\n]*);" named "${entry}")
set(named "${CMAKE_MATCH_1}")
if(named STREQUAL "")
    message(FATAL_ERROR "The desktop entry names no types of files.")
endif()
foreach(type IN LISTS named)
    expect("${types}" "mime-type type=\"${type}\"")
endforeach()

# The tarball: the command line, and nothing that needs a display.
file(GLOB tarball ${WORK}/curvewright-cli-${VERSION}*.tar.gz)
file(ARCHIVE_EXTRACT INPUT ${tarball} DESTINATION ${WORK}/tarball)
file(GLOB_RECURSE files RELATIVE ${WORK}/tarball ${WORK}/tarball/*)
expect("${files}" "bin/curvewright-cli")
expect("${files}" "man1/curvewright-cli.1.gz")
expect("${files}" "libexec/curvewright/curvewright-vtk-reader")
if(files MATCHES "bin/curvewright(;|$)|\\.desktop|sample_meshes|\\.a(;|$)")
    message(FATAL_ERROR "In the tarball, but not of the command line: ${files}")
endif()
file(GLOB_RECURSE program ${WORK}/tarball/*/curvewright-cli ${WORK}/tarball/bin/curvewright-cli)
list(GET program 0 program)
run(0 ${program} --version)
expect("${output}" "${VERSION}")
run(0 ${program} quality ${WORK}/sample.vtu --json)
expect("${output}" "\"invalid\": 0")
