# What every target of ours shares: the language level, the warnings, the sanitizers. Nothing here is global. The options
# are installed with the library (a library built with a sanitizer can only be linked with it), the warnings are not.

add_library(curvewright_options INTERFACE)
target_compile_features(curvewright_options INTERFACE cxx_std_20)
target_include_directories(curvewright_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
if(CURVEWRIGHT_SANITIZER)
    target_compile_options(curvewright_options INTERFACE -fsanitize=${CURVEWRIGHT_SANITIZER} -fno-omit-frame-pointer
                                                         -fno-sanitize-recover=undefined)
    target_link_options(curvewright_options INTERFACE -fsanitize=${CURVEWRIGHT_SANITIZER})
endif()

add_library(curvewright_warnings INTERFACE)
target_compile_options(curvewright_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                                      -Woverloaded-virtual -Wcast-qual -Wimplicit-fallthrough)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 sees overflows in its own std::string and std::vector (GCC bugs 105329, 105762).
    target_compile_options(curvewright_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow)
endif()

# curvewright_configure(TARGET): warnings, language level and sanitizers for one of our targets.
function(curvewright_configure target)
    target_link_libraries(${target} PUBLIC curvewright_options
                                    PRIVATE $<BUILD_INTERFACE:curvewright_warnings>)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
endfunction()

# curvewright_precompile(TARGET HEADERS...): headers that many files of a target read are compiled once. Only headers from
# outside, which do not change; every file includes what it uses all the same, and builds with the option off.
function(curvewright_precompile target)
    if(CURVEWRIGHT_PRECOMPILED_HEADERS)
        target_precompile_headers(${target} PRIVATE ${ARGN})
    endif()
endfunction()

# curvewright_reuse_precompiled(TARGET OWNER): with the headers that another target, compiled alike, has compiled.
function(curvewright_reuse_precompiled target owner)
    if(CURVEWRIGHT_PRECOMPILED_HEADERS)
        target_precompile_headers(${target} REUSE_FROM ${owner})
    endif()
endfunction()
