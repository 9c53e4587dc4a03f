# What `cmake --install` puts where. Component "library": the static library, its headers and the CMake package
# Curvewright (target Curvewright::core). Component "programs": the programs, their samples and the desktop entry.

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

install(EXPORT CurvewrightTargets NAMESPACE Curvewright:: DESTINATION ${package_folder} COMPONENT library)
configure_package_config_file(cmake/CurvewrightConfig.cmake.in ${PROJECT_BINARY_DIR}/CurvewrightConfig.cmake
    INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/CurvewrightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/CurvewrightConfig.cmake ${PROJECT_BINARY_DIR}/CurvewrightConfigVersion.cmake
              cmake/FindMETIS.cmake cmake/FindWebP.cmake
        DESTINATION ${package_folder} COMPONENT library)

install(TARGETS curvewright-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
if(CURVEWRIGHT_BUILD_DESKTOP)
    install(TARGETS curvewright RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
    install(FILES resources/curvewright.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT programs)
    install(FILES resources/icons/curvewright.svg
            DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT programs)
    install(DIRECTORY sample_meshes DESTINATION ${CMAKE_INSTALL_DATADIR}/curvewright COMPONENT programs)
endif()

# Each component brings the license along.
foreach(component library programs)
    install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT ${component})
endforeach()
