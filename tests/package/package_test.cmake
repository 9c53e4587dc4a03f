# Installs the library into an empty folder, builds the examples against it and runs them. Called by ctest with the
# variables that CMakeLists.txt beside this file names.

cmake_policy(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/checks.cmake)

file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(0 ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --component library --prefix ${prefix})

# Headers only, and none that needs VTK.
file(GLOB_RECURSE headers RELATIVE ${prefix}/${INCLUDE_FOLDER} ${prefix}/${INCLUDE_FOLDER}/*)
expect("${headers}" "curvewright/curvewright.h")
expect("${headers}" "curvewright/core/warp/warp.h")
if(headers MATCHES "vtk|\\.cpp")
    message(FATAL_ERROR "Installed, but not for users: ${headers}")
endif()

# The installed package first, then whatever this build was told to search. In the environment, where lists survive.
list(JOIN PREFIX_PATH ":" searched)
set(ENV{CMAKE_PREFIX_PATH} "${prefix}:${searched}:$ENV{CMAKE_PREFIX_PATH}")
run(0 ${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${COMPILER_FLAGS} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
run(0 ${CMAKE_COMMAND} --build ${WORK}/build --config ${CONFIG})

# The user's compiler sees neither the folders of VTK and Qt nor our source tree and warnings.
if(EXISTS ${WORK}/build/compile_commands.json)
    file(READ ${WORK}/build/compile_commands.json commands)
    expect("${commands}" "-std=[a-z+]*20")
    if(commands MATCHES "-(I|isystem) ?[^ ]*/(vtk|qt)[-0-9.]*[ /\"]|-Wall|-I${SOURCE}[ \"]")
        message(FATAL_ERROR "The package leaks into its user's compile: ${commands}")
    endif()
endif()

foreach(name warp_mesh custom_weights drag_boundary)
    find_program(${name} ${name} PATHS ${WORK}/build ${WORK}/build/${CONFIG} NO_DEFAULT_PATH REQUIRED)
endforeach()
set(sample ${SOURCE}/sample_meshes/moving_circle)
run(0 ${warp_mesh} ${sample}/moving_circle.msh ${sample}/deformation.json ${WORK}/warped.vtu)
expect("${output}" "before .* min 1\\.0000, mean 1\\.0000; 1660 valid, 0 invalid, 0 undecided")
expect("${output}" "after .* min 0\\.[0-9]+, mean 0\\.[0-9]+; 1660 valid, 0 invalid, 0 undecided")
file(READ ${WORK}/warped.vtu result)
expect("${result}" "Name=\"ScaledJacobian\"")
expect("${result}" "Name=\"Displacement\"")

# The program reads what it wrote with the installed program for VTK files.
# Moved as far again, some elements tangle, which its status tells.
run(3 ${warp_mesh} ${WORK}/warped.vtu ${sample}/deformation.json ${WORK}/again.vtu)
expect("${output}" "before .* 1660 valid, 0 invalid, 0 undecided")

run(0 ${custom_weights} ${sample}/moving_circle.msh ${sample}/deformation.json)
expect("${output}" "convex +min 0\\.[0-9]+, mean 0\\.9[0-9]+; 0 invalid")
expect("${output}" "inverse distance +min -?[0-9.]+, mean [0-9.]+; [0-9]+ invalid")
run(0 ${drag_boundary} ${sample}/moving_circle.msh circle)
expect("${output}" "turned by 10 degrees: min +0\\.[0-9]+, 0 invalid.*turned by 90 degrees")

# An error is one sentence, the last line, that names the file; it leaves nothing behind.
run(1 ${warp_mesh} ${WORK}/missing.msh ${sample}/deformation.json ${WORK}/none.vtu)
expect("${errors}" "\n[^\n]*missing\\.msh: [^\n]*\\.\n$")
if(EXISTS ${WORK}/none.vtu)
    message(FATAL_ERROR "A failed run left a file behind.")
endif()
