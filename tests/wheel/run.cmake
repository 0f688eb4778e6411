# Makes the wheel, installs it into a separate environment and tests it there, with nothing else on the PATH. The dependencies
# (numpy, h5py, ...) are those of build/venv. Variables: SOURCE_DIR, WORK_DIR, PYTHON.
include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
# Not optimised: compiled in half the time.
step(${CMAKE_COMMAND} -E env SKBUILD_CMAKE_BUILD_TYPE=Debug sh ${SOURCE_DIR}/scripts/wheel.sh)
file(GLOB wheel ${SOURCE_DIR}/build/wheel/mfv_contact-*.whl)
step(${PYTHON} -m venv ${WORK_DIR}/venv)
set(python ${WORK_DIR}/venv/bin/python)
step(${python} -m pip install --quiet --disable-pip-version-check --no-index --no-deps ${wheel})
set(where "print(__import__('sysconfig').get_path('purelib'), end='')")
step(${PYTHON} -c ${where})
set(dependencies ${step_output})
step(${python} -c ${where})
file(WRITE ${step_output}/dependencies.pth ${dependencies})
set(suites ${SOURCE_DIR}/tests/wheel)
foreach(suite case scene result)
  list(APPEND suites ${SOURCE_DIR}/tests/python/test_${suite}.py)
endforeach()
step(env -i PATH=${WORK_DIR}/venv/bin HOME=${WORK_DIR} MPLBACKEND=Agg OPENBLAS_NUM_THREADS=1
  MFV_RUN=${WORK_DIR}/venv/bin/mfv_run ${python} -m pytest -q -p no:cacheprovider ${suites})
message(STATUS "${step_output}")
