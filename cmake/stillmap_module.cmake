# SPDX-License-Identifier: Apache-2.0
# stillmap_module(NAME core SOURCES a.cpp HEADERS a.hpp USES other PRIVATE_LIBS lib PUBLIC_LIBS lib TESTS a_test.cpp
#   TEST_USES module TEST_LIBS lib)
# One static library a module, stillmap::NAME, with one test program, NAME_test, beside it. A module
# that is no part of the library is declared stillmap_module(NOT_INSTALLED NAME ...).

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
  target_link_options(stillmap_options INTERFACE $<BUILD_INTERFACE:-fsanitize=${STILLMAP_SANITIZE}>)
endif()
install(TARGETS stillmap_options EXPORT stillmap)

function(stillmap_tests NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES" ${ARGN})
  if(NOT STILLMAP_BUILD_TESTS OR NOT ARG_SOURCES)
    return()
  endif()
  add_executable(${NAME}_test ${ARG_SOURCES})
  target_link_libraries(${NAME}_test PRIVATE stillmap_options ${ARG_USES} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${NAME}_test PRIVATE
    STILLMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" STILLMAP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_target_properties(${NAME}_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  gtest_discover_tests(${NAME}_test TEST_PREFIX ${NAME}. DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT 300)
endfunction()

function(stillmap_module)
  cmake_parse_arguments(ARG "NOT_INSTALLED" "NAME" "SOURCES;HEADERS;USES;PUBLIC_LIBS;PRIVATE_LIBS;TESTS;TEST_USES;TEST_LIBS" ${ARGN})
  set(target stillmap_${ARG_NAME})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(stillmap::${ARG_NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${ARG_NAME})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ARG_HEADERS})
  list(TRANSFORM ARG_USES PREPEND stillmap::)
  target_link_libraries(${target}
    PUBLIC stillmap_options ${ARG_USES} ${ARG_PUBLIC_LIBS} PRIVATE ${ARG_PRIVATE_LIBS})
  if(NOT ARG_NOT_INSTALLED)
    install(TARGETS ${target} EXPORT stillmap FILE_SET HEADERS ARCHIVE)
  endif()
  list(TRANSFORM ARG_TEST_USES PREPEND stillmap::)
  stillmap_tests(${ARG_NAME} SOURCES ${ARG_TESTS} USES stillmap::${ARG_NAME} ${ARG_TEST_USES} ${ARG_TEST_LIBS})
endfunction()
