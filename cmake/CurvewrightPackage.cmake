# What `cpack` makes: with -G DEB a package of the programs for the Debian that it is built on, with -G TGZ a tarball of the
# command line.

set(CPACK_PACKAGE_NAME curvewright)
set(CPACK_PACKAGE_VENDOR Curvewright)
set(CPACK_PACKAGE_CONTACT "The Curvewright authors <curvewright@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "viewer, editor and untangler of curved high-order meshes")
set(CPACK_PACKAGE_DESCRIPTION
    "Shows meshes of curved finite elements coloured by a certified scaled Jacobian, moves their boundaries by hand or by file, \
lets the interior follow, untangles what has become invalid, step by step if wanted, and writes MSH and VTU. The same engine runs \
without a display in curvewright-cli.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/CurvewrightPackageKinds.cmake)

set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is loaded by name and so is no dependency that a linker knows: the window system, icons, OpenGL without a display.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "qt6-qpa-plugins, libqt6svg6, libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "gmsh, ffmpeg")
include(CPack)
