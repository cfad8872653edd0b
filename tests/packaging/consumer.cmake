# cmake -DBUILD=... -DCOMPILER=... -DBUILD_TYPE=... -DWORK=... -P consumer.cmake
function(step)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

foreach(file bin/sandlane share/man/man1/sandlane.1 share/sandlane/scenes/drum.toml share/doc/sandlane/README.md)
  if(NOT EXISTS ${WORK}/prefix/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()

# Flags of ours, or the place it was built in, would follow every user.
file(GLOB_RECURSE exported ${WORK}/prefix/*/sandlane-targets*.cmake)
foreach(file IN LISTS exported)
  file(STRINGS ${file} leaks REGEX "-Werror|-fsanitize|sandlane_flags|${BUILD}")
  if(leaks)
    message(FATAL_ERROR "${file} exports: ${leaks}")
  endif()
endforeach()

# Moved after installation: nothing may depend on the prefix.
file(RENAME ${WORK}/prefix ${WORK}/moved)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK}/consumer -G Ninja
  -DCMAKE_PREFIX_PATH=${WORK}/moved -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
step(${CMAKE_COMMAND} --build ${WORK}/consumer)
step(${WORK}/consumer/consumer ${WORK}/moved/share/sandlane/scenes/drum.toml)
