# Fetches the packages of the lock file and bundles the page. What goes wrong (no network, say) is a
# warning: the program is built without it.
# usage: cmake -D NODE=... -D NPM=... -D SOURCE=... -D FOLDER=... -P build_viewer.cmake
set(work ${FOLDER}/work)
file(MAKE_DIRECTORY ${work})
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/build.mjs ${SOURCE}/scenes.mjs
          ${SOURCE}/src
     DESTINATION ${work})
# A page of other sources is none: it goes before the new one is made.
file(REMOVE ${FOLDER}/viewer.html ${FOLDER}/viewer.stamp)
file(SHA256 ${SOURCE}/package-lock.json lock)
set(fetched ${work}/node_modules/fetched)
set(have "")
if(EXISTS ${fetched})
  file(READ ${fetched} have)
endif()
set(failed 0)
if(NOT have STREQUAL lock)
  execute_process(COMMAND ${NPM} ci --omit=dev --no-audit --no-fund --loglevel=error
                  WORKING_DIRECTORY ${work} RESULT_VARIABLE failed OUTPUT_QUIET)
  if(failed EQUAL 0)
    file(WRITE ${fetched} ${lock})
  endif()
endif()
if(failed EQUAL 0)
  execute_process(COMMAND ${NODE} build.mjs ${FOLDER}/viewer.html
                  WORKING_DIRECTORY ${work} RESULT_VARIABLE failed)
endif()
if(failed EQUAL 0)
  file(TOUCH ${FOLDER}/viewer.stamp)
else()
  message(WARNING "kairos view: its page could not be built; it is tried again with the next build")
endif()
