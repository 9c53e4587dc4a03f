# Debian's packages; scripts/packages.sh lists them by name. What core links stands in CurvewrightConfig.cmake.in too.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(METIS REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json 3.10 REQUIRED)
find_package(CLI11 2.0 REQUIRED)
find_package(muparser REQUIRED)
find_package(ZLIB REQUIRED)
find_package(WebP REQUIRED)
find_package(Threads REQUIRED)

if(CURVEWRIGHT_BUILD_DESKTOP)
    find_package(Qt6 6.4 REQUIRED COMPONENTS Core Gui Widgets OpenGLWidgets Svg)
endif()

# Components named one by one: the whole of VTK costs minutes of link and start-up time.
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel CommonColor RenderingCore
             RenderingOpenGL2 RenderingAnnotation RenderingFreeType InteractionStyle IOLegacy IOXML IOImage)

if(CURVEWRIGHT_BUILD_TESTS)
    find_package(GTest REQUIRED)
    find_package(VTK 9.1 REQUIRED COMPONENTS FiltersVerdict)
    if(CURVEWRIGHT_BUILD_DESKTOP)
        find_package(Qt6 6.4 REQUIRED COMPONENTS Test)
    endif()
endif()
if(CURVEWRIGHT_BUILD_BENCHMARKS)
    find_package(benchmark REQUIRED)
endif()
