# cmake -DBUILD_DIR=<built evert> -DSOURCE_DIR=<this folder> -DWORK_DIR=<scratch> -DGENERATOR=<that of evert>
#   -P find_package_test.cmake
# Installs Evert into a stage and uses it from another project; the installed program starts too.
cmake_minimum_required(VERSION 3.24)
file(REMOVE_RECURSE ${WORK_DIR})

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(stage ${WORK_DIR}/stage)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${stage})
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE_DIR}/find_package -B ${WORK_DIR}/build -DCMAKE_PREFIX_PATH=${stage})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/uses_evert)
run(${stage}/bin/evert --version)
file(REMOVE_RECURSE ${WORK_DIR})
