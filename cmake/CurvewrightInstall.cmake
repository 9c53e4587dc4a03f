# What `cmake --install` puts where. Component "library": the static library, its headers and the CMake package
# Curvewright (targets Curvewright::core and Curvewright::vtk_reader). Component "cli": the command line. Component "desktop": the window, its samples, and
# what a desktop wants to know of it.

include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Curvewright)
set(header_folder ${CMAKE_INSTALL_INCLUDEDIR}/curvewright)

set_target_properties(curvewright_core PROPERTIES EXPORT_NAME core)
set_target_properties(curvewright_options PROPERTIES EXPORT_NAME options)

# The inner headers keep their "core/..." below the header folder, so that is an include directory of the target, too.
install(TARGETS curvewright_core curvewright_options EXPORT CurvewrightTargets COMPONENT library
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${header_folder})
install(FILES core/curvewright.h DESTINATION ${header_folder} COMPONENT library)
install(DIRECTORY core DESTINATION ${header_folder} COMPONENT library FILES_MATCHING PATTERN "*.h"
        PATTERN "vtk_*" EXCLUDE PATTERN "curvewright.h" EXCLUDE)

# The program that reads VTK files goes with each of them: no other reads one without it. A library knows it by the
# definition, wherever the whole has been moved to.
set_target_properties(curvewright-vtk-reader PROPERTIES EXPORT_NAME vtk_reader)
target_compile_definitions(curvewright_core INTERFACE
    $<INSTALL_INTERFACE:CURVEWRIGHT_VTK_READER="$<INSTALL_PREFIX>/${CURVEWRIGHT_LIBEXEC_FOLDER}/curvewright-vtk-reader">)
install(TARGETS curvewright-vtk-reader EXPORT CurvewrightTargets
    RUNTIME DESTINATION ${CURVEWRIGHT_LIBEXEC_FOLDER} COMPONENT library)
foreach(component cli desktop)
    install(TARGETS curvewright-vtk-reader RUNTIME DESTINATION ${CURVEWRIGHT_LIBEXEC_FOLDER} COMPONENT ${component})
endforeach()

install(EXPORT CurvewrightTargets NAMESPACE Curvewright:: DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(cmake/CurvewrightConfig.cmake.in ${PROJECT_BINARY_DIR}/CurvewrightConfig.cmake
    INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/CurvewrightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/CurvewrightConfig.cmake ${PROJECT_BINARY_DIR}/CurvewrightConfigVersion.cmake
              cmake/FindMETIS.cmake cmake/FindWebP.cmake
        DESTINATION ${package_folder} COMPONENT library)

# Debian wants manual pages compressed, without a time in them.
function(install_manual name component)
    set(page ${PROJECT_BINARY_DIR}/man/${name}.1.gz)
    find_program(GZIP_PROGRAM gzip REQUIRED)
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/man)
    configure_file(resources/man/${name}.1 ${PROJECT_BINARY_DIR}/man/${name}.1 COPYONLY)
    execute_process(COMMAND ${GZIP_PROGRAM} -9nc ${PROJECT_BINARY_DIR}/man/${name}.1 OUTPUT_FILE ${page}
                    COMMAND_ERROR_IS_FATAL ANY)
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
endfunction()

install(TARGETS curvewright-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT cli)
install_manual(curvewright-cli cli)
if(CURVEWRIGHT_BUILD_DESKTOP)
    install(TARGETS curvewright RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT desktop)
    install_manual(curvewright desktop)
    install(FILES resources/curvewright.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT desktop)
    install(FILES resources/curvewright-mime.xml RENAME curvewright.xml
            DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT desktop)
    install(FILES resources/icons/curvewright.svg
            DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT desktop)
    install(DIRECTORY sample_meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/curvewright COMPONENT desktop
            PATTERN "*.py" EXCLUDE PATTERN "*.sh" EXCLUDE)
endif()

# Each component brings the license along, where Debian looks for it.
foreach(component library cli desktop)
    install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/curvewright COMPONENT ${component})
endforeach()
