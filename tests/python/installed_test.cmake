# Installs kairos to a prefix of its own and runs the package from there, as a stranger would.
cmake_minimum_required(VERSION 3.25)
set(prefix ${BUILD_DIR}/python-installed)
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env --unset=KAIROS_PROGRAM --unset=KAIROS_DATA
          PYTHONPATH=${prefix}/${PACKAGES} ${PYTHON} -c "
import kairos, os
assert kairos.__file__.startswith('${prefix}'), kairos.__file__
assert kairos.program() == '${prefix}/bin/kairos', kairos.program()
assert kairos.run('bounce', duration=1).status == 'completed'
folder = os.path.dirname(kairos.__file__)
assert all(os.path.exists(os.path.join(folder, name)) for name in ('py.typed', '_kairos.pyi', '_options.pyi'))
print('installed')"
  OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
if(NOT said MATCHES "installed")
  message(FATAL_ERROR "${said}")
endif()
