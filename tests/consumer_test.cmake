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

function(says program expected)  # further arguments go to the program
  run(${build}/${program} ${ARGN})
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${program} says: ${output}")
  endif()
endfunction()

# The ball falls 4.9 m: t = sqrt(2 * 4.9 / 9.8) = 1.
says(ten_lines "^impact in .1, 1. s")
file(READ ${build}/scenes.txt scenes)  # where the package says they are
says(run_scene "^0.461037 s: impact\n" ${scenes}/drag-drop.toml)
# The plank's lower face meets the crate's edge at (-0.5, 0.5): 0.5 sin t - 0.7 cos t = -0.1,
# t = atan(1.4) - asin(0.1 / sqrt(0.74)) = 0.83404.
says(box_box "certified: impact at 0.83403|certified: impact at 0.83404")
# 3 t^2 - 2 t^3 = 0.85: t = 0.755597645549.
says(spline_motion "^touches at 0.7555976455")
# A speed above 1 m/s of up to 2 m/s: about half of them.
says(batch "^(4[5-9][0-9]|5[0-4][0-9]) of 1000 arrive")
says(own_force "^x = -1 m|^x = -0.99999999")
# 1 s down at 3 m/s, 1 s up at 1 m/s.
says(own_law "^y = 1.1 m, unexplained 0 J|^y = 1.1 m, unexplained -?[0-9.]+e-1[5-9] J")
file(READ ${build}/wrong.txt wrong)
if(NOT wrong MATCHES "^(FALSE|0) kairos has no component 'physics'; there are: core, ccd")
  message(FATAL_ERROR "a wrong component: ${wrong}")
endif()
# The installed program finds the installed scenes.
run(${prefix}/bin/kairos explain bounce)
