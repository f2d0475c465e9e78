# SPDX-License-Identifier: Apache-2.0
# stillmap_module(NAME core USES other PUBLIC_LIBS lib PRIVATE_LIBS lib SOURCES generated.cpp PRIVATE_HEADERS a.hpp
#   TEST_USES module TEST_LIBS lib)
#
# One folder, one static library stillmap::NAME, one test program NAME_test: *_test.cpp are the tests, every other *.cpp
# is the library; SOURCES adds what is generated. USES names the modules that the folder's files include; it is what
# tools/check_layers.py checks. PRIVATE_HEADERS are for the folder's own files.

add_library(stillmap_options INTERFACE)
target_compile_features(stillmap_options INTERFACE cxx_std_20)
# GCC 12 sees overlapping copies in plain std::string code (its bug 105651), hence -Wno-restrict.
target_compile_options(stillmap_options INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual>
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>
  $<BUILD_INTERFACE:$<$<BOOL:${STILLMAP_WERROR}>:-Werror>>)
if(STILLMAP_SANITIZE)
  target_compile_options(stillmap_options INTERFACE
    $<BUILD_INTERFACE:-fsanitize=${STILLMAP_SANITIZE};-fno-omit-frame-pointer;-fno-sanitize-recover=all>)
  if(NOT STILLMAP_FUZZ)
    # Half of the compiler's time would go into these, which find what the address sanitizer finds a moment later.
    target_compile_options(stillmap_options INTERFACE
      $<BUILD_INTERFACE:-fno-sanitize=null;-fno-sanitize=object-size;-fno-sanitize=pointer-overflow;-fno-sanitize=vptr>)
  endif()
  target_link_options(stillmap_options INTERFACE $<BUILD_INTERFACE:-fsanitize=${STILLMAP_SANITIZE}>)
endif()
install(TARGETS stillmap_options EXPORT stillmap)

# The headers of other libraries that most files read are read once, for all modules together, and
# once more with GoogleTest for all tests. The tidy preset builds without, so
# that each file includes what it uses.
function(stillmap_precompiled NAME)
  file(WRITE ${PROJECT_BINARY_DIR}/precompiled/${NAME}.cpp.in "// Compiles nothing: its target holds precompiled headers.\n")
  configure_file(${PROJECT_BINARY_DIR}/precompiled/${NAME}.cpp.in ${PROJECT_BINARY_DIR}/precompiled/${NAME}.cpp COPYONLY)
  add_library(${NAME} OBJECT ${PROJECT_BINARY_DIR}/precompiled/${NAME}.cpp)
  target_link_libraries(${NAME} PRIVATE stillmap_options Eigen3::Eigen opencv_core fmt::fmt Threads::Threads)
  set_target_properties(${NAME} PROPERTIES UNITY_BUILD OFF)
  target_precompile_headers(${NAME} PRIVATE
    <algorithm> <array> <cmath> <cstddef> <cstdint> <deque> <filesystem> <functional> <future> <map> <memory> <optional>
    <set> <span> <string> <string_view> <thread> <utility> <vector>
    <Eigen/Core> <Eigen/Geometry> <fmt/core.h> <opencv2/core/mat.hpp> ${ARGN})
endfunction()
# Tests link libraries that are optimised in full; their own files need less: some of the time is saved,
# and GCC 12's false warnings about plain std::string code. Precompiled headers and the files that read them
# have the same level: GCC goes by the header's.
set(stillmap_test_optimization $<$<NOT:$<CONFIG:Debug>>:-O1>)
stillmap_precompiled(stillmap_precompiled_library)
if(STILLMAP_BUILD_TESTS)
  stillmap_precompiled(stillmap_precompiled_tests <gmock/gmock.h> <gtest/gtest.h>)
  target_link_libraries(stillmap_precompiled_tests PRIVATE GTest::gmock)
  target_compile_options(stillmap_precompiled_tests PRIVATE ${stillmap_test_optimization})
endif()

# An executable whose files read them: -fPIC as they were made with, not -fPIE.
function(stillmap_use_precompiled TARGET NAME)
  set_target_properties(${TARGET} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  target_compile_options(${TARGET} PRIVATE -fPIC)
  target_precompile_headers(${TARGET} REUSE_FROM ${NAME})
endfunction()

# CTest's list of a program's tests is written when the program is linked (cmake/discover_tests.cmake).
# cmake/test_kinds.cmake names the slow ones, those that may be skipped, and those that sanitizers leave out.
include(test_kinds)
function(stillmap_discover_tests NAME)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_test_list.cmake)
  list(JOIN stillmap_slow_tests_${NAME} "," slow)
  list(JOIN stillmap_lone_tests "|" lone)
  list(JOIN stillmap_unsanitized_tests "|" disabled)
  list(JOIN stillmap_whole_stack_tests "|" whole_stacks)
  add_custom_command(TARGET ${NAME}_test POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${NAME}_test> -DNAME=${NAME} "-DLONE=${lone}" "-DSLOW=${slow}"
      "-DDISABLED=${disabled}" "-DWHOLE_STACKS=${whole_stacks}" -DTIMEOUT=${stillmap_test_timeout_s} -DOUT=${list}
      -P ${PROJECT_SOURCE_DIR}/cmake/discover_tests.cmake
    VERBATIM)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_test_include.cmake
    "if(EXISTS \"${list}\")\n  include(\"${list}\")\nelse()\n  add_test(${NAME}_test_NOT_BUILT ${NAME}_test_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_test_include.cmake)
  set_property(TARGET ${NAME}_test APPEND PROPERTY LINK_DEPENDS
    ${PROJECT_SOURCE_DIR}/cmake/discover_tests.cmake ${PROJECT_SOURCE_DIR}/cmake/test_kinds.cmake)
endfunction()

function(stillmap_tests NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES" ${ARGN})
  if(NOT STILLMAP_BUILD_TESTS OR NOT ARG_SOURCES)
    return()
  endif()
  add_executable(${NAME}_test ${ARG_SOURCES})
  target_include_directories(${NAME}_test PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${NAME}_test PRIVATE stillmap_options ${ARG_USES} GTest::gmock GTest::gtest_main)
  stillmap_use_precompiled(${NAME}_test stillmap_precompiled_tests)
  target_compile_options(${NAME}_test PRIVATE ${stillmap_test_optimization})
  target_compile_definitions(${NAME}_test PRIVATE
    STILLMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" STILLMAP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_target_properties(${NAME}_test PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests UNITY_BUILD_BATCH_SIZE 6)
  stillmap_discover_tests(${NAME})
endfunction()

function(stillmap_module)
  cmake_parse_arguments(ARG "" "NAME" "USES;PUBLIC_LIBS;PRIVATE_LIBS;SOURCES;PRIVATE_HEADERS;TEST_USES;TEST_LIBS" ${ARGN})
  set(target stillmap_${ARG_NAME})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(TRANSFORM ARG_USES PREPEND stillmap::)
  list(APPEND sources ${ARG_SOURCES})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_precompile_headers(${target} REUSE_FROM stillmap_precompiled_library)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(stillmap::${ARG_NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${ARG_NAME})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} ${scope} stillmap_options ${ARG_USES} ${ARG_PUBLIC_LIBS})
  if(ARG_PRIVATE_LIBS)
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE_LIBS})
  endif()
  list(TRANSFORM ARG_TEST_USES PREPEND stillmap::)
  stillmap_tests(${ARG_NAME} SOURCES ${tests} USES stillmap::${ARG_NAME} ${ARG_TEST_USES} ${ARG_TEST_LIBS})
endfunction()
