# SPDX-License-Identifier: Apache-2.0
# cmake -DPROGRAM=x_test -DNAME=x -DLONE=patterns -DSLOW=a=2,b=30 -DDISABLED=patterns -DWHOLE_STACKS=patterns
#   -DTIMEOUT=s -DOUT=f.cmake -P discover_tests.cmake
#
# Asks a GoogleTest program for its tests and writes OUT, CTest's list of them: one test NAME.FILE for each file
# FILE_test.cpp, so that its tests share a process and what they render. Tests that may be skipped (LONE: expressions
# for SUITE.TEST) are tests of their own, so that CTest shows them as skipped (and a skipped test
# among others is a failure: LONE lacks it). SLOW names the slow files and their
# seconds; CTest starts long ones first. DISABLED: expressions for names of tests that CTest shall list and not run.
# WHOLE_STACKS: expressions for those of LONE in which the address sanitizer notes each allocation's whole stack.
set(listing ${OUT}.json)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_output=json:${listing}
  OUTPUT_QUIET ERROR_VARIABLE errors RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its tests:\n${errors}")
endif()
file(READ ${listing} json)

set(files)
set(lone)
string(JSON suites LENGTH ${json} testsuites)
math(EXPR last_suite "${suites} - 1")
foreach(s RANGE ${last_suite})
  string(JSON suite GET ${json} testsuites ${s})
  string(JSON suite_name GET ${suite} name)
  string(JSON tests LENGTH ${suite} testsuite)
  math(EXPR last_test "${tests} - 1")
  foreach(t RANGE ${last_test})
    string(JSON test_name GET ${suite} testsuite ${t} name)
    string(JSON file GET ${suite} testsuite ${t} file)
    string(REGEX REPLACE ".*/|_test[.]cpp$" "" file ${file})
    set(full_name ${suite_name}.${test_name})
    if(LONE AND full_name MATCHES "${LONE}")
      list(APPEND lone ${full_name})
      set(lone_file_${full_name} ${file})
    else()
      list(APPEND files ${file})
      list(APPEND filter_${file} ${full_name})
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES files)

set(content "")
function(add NAME FILE FILTER PROPERTIES)
  set(label fast)
  set(seconds 0)
  if(",${SLOW}," MATCHES ",${FILE}=([0-9]+),")
    set(label slow)
    set(seconds ${CMAKE_MATCH_1})
  endif()
  if(DISABLED AND NAME MATCHES "${DISABLED}")
    string(APPEND PROPERTIES " DISABLED TRUE")
  endif()
  string(APPEND content "add_test([=[${NAME}]=] \"${PROGRAM}\" \"--gtest_filter=${FILTER}\")\n"
    "set_tests_properties([=[${NAME}]=] PROPERTIES TIMEOUT ${TIMEOUT} LABELS ${label} COST ${seconds} ${PROPERTIES})\n")
  set(content "${content}" PARENT_SCOPE)
endfunction()
foreach(file IN LISTS files)
  list(JOIN filter_${file} ":" filter)
  add(${NAME}.${file} ${file} "${filter}" "FAIL_REGULAR_EXPRESSION \"\\\\[  SKIPPED \\\\]\"")
endforeach()
foreach(test IN LISTS lone)
  set(properties "SKIP_REGULAR_EXPRESSION \"\\\\[  SKIPPED \\\\]\"")
  if(WHOLE_STACKS AND test MATCHES "${WHOLE_STACKS}")
    string(APPEND properties " ENVIRONMENT ASAN_OPTIONS=fast_unwind_on_malloc=0")
  endif()
  add(${NAME}.${lone_file_${test}}.${test} ${lone_file_${test}} "${test}" "${properties}")
endforeach()
file(WRITE ${OUT} "${content}")
