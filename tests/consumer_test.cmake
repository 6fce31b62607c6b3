# Installs kairos to a prefix of its own and builds tests/consumer against that, as a stranger would.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix ${BUILD_DIR}/consumer/prefix)
set(build ${BUILD_DIR}/consumer/build)
file(REMOVE_RECURSE ${BUILD_DIR}/consumer)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${build} -G ${GENERATOR}
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${COMPILER}
    -D CMAKE_CXX_FLAGS=${FLAGS} -D CMAKE_BUILD_TYPE=${BUILD_TYPE})
run(${CMAKE_COMMAND} --build ${build})

# The ball falls 4.9 m: t = sqrt(2 * 4.9 / 9.8) = 1.
run(${build}/ten_lines)
if(NOT output MATCHES "^impact in .1, 1. s")
  message(FATAL_ERROR "ten_lines says: ${output}")
endif()
file(READ ${build}/scenes.txt scenes)  # where the package says they are
run(${build}/run_scene ${scenes}/drag-drop.toml)
if(NOT output MATCHES "^0.461037 s: impact\n")
  message(FATAL_ERROR "run_scene says: ${output}")
endif()
# The installed program finds the installed scenes.
run(${prefix}/bin/kairos explain bounce)
