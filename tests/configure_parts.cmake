# SPDX-License-Identifier: Apache-2.0
# Configures the library with tooling or simulation off, or both, on a machine that seems to lack the
# packages that only they need.
set(tooling_packages CLI11 octomap)
set(simulation_packages embree tinyobjloader LIBZIP) # the last is pkg-config's

# Configures with these parts ON, without these packages. Afterwards `failed` and `text` are set, and
# `cache` is what the cache holds.
function(configure NAME TOOLING SIMULATION)
  set(hidden "")
  foreach(package IN LISTS ARGN)
    list(APPEND hidden -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  set(build ${WORK_DIR}/${NAME})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${build} -G ${GENERATOR}
      -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DSTILLMAP_BUILD_TESTS=OFF
      -DSTILLMAP_BUILD_TOOLING=${TOOLING} -DSTILLMAP_BUILD_SIMULATION=${SIMULATION} ${hidden}
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(cache "")
  if(EXISTS ${build}/CMakeCache.txt)
    file(READ ${build}/CMakeCache.txt cache)
  endif()
  set(failed ${result} PARENT_SCOPE)
  set(text "${text}" PARENT_SCOPE)
  set(cache "${cache}" PARENT_SCOPE)
endfunction()

# The configuration succeeds, and asks for none of the packages.
function(expect_without NAME TOOLING SIMULATION)
  configure(${NAME} ${TOOLING} ${SIMULATION} ${ARGN})
  if(failed)
    message(FATAL_ERROR "${NAME}: does not configure:\n${text}")
  endif()
  foreach(package IN LISTS ARGN)
    if(cache MATCHES "\n${package}_(DIR|FOUND|LIBRARIES|INCLUDE_DIRS):")
      message(FATAL_ERROR "${NAME}: asked for ${package}")
    endif()
  endforeach()
  message("${NAME}: configures without ${ARGN}")
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
expect_without(library OFF OFF ${tooling_packages} ${simulation_packages})
expect_without(library_and_tooling ON OFF ${simulation_packages})
expect_without(library_and_simulation OFF ON ${tooling_packages})
# Hiding a package that is needed is seen, so that the above proves something.
configure(all ON ON embree)
if(NOT failed OR NOT text MATCHES "embree")
  message(FATAL_ERROR "all: configured without embree:\n${text}")
endif()
