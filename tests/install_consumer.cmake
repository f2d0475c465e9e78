# SPDX-License-Identifier: Apache-2.0
# Installs the build into a fresh folder and builds and runs, against that alone, the project in
# consumer/.
function(step NAME)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  message("${text}")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${NAME} failed: ${result}")
  endif()
  set(step_output "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
step("install" ${CMAKE_COMMAND} --install ${STILLMAP_BINARY_DIR} --prefix ${WORK_DIR}/prefix)
step("configure" ${CMAKE_COMMAND} -S ${CONSUMER_SOURCE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
  -DHEADERS=${HEADERS} -DVERSION=${VERSION} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
  -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
step("build" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
step("run" ${WORK_DIR}/build/consumer)
if(NOT step_output MATCHES "camera tum_fr3: 640 x 480")
  message(FATAL_ERROR "the consumer printed something else")
endif()
step("version" ${WORK_DIR}/prefix/bin/stillmap --version)
