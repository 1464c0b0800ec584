# Tests as ctest sees them. Every one has labels, any of: unit (quick, without rendering and sockets), sim (flies or
# renders the simulator), network (opens sockets, starts servers or a browser, or asks a package index), slow (more than a
# minute on one core). tests/labels_test.py holds this.

# Builds what `ctest --label-regex unit` runs.
add_custom_target(unit_tests)

# alight_gtest_entry(entry executable LABELS ... [ARGUMENTS ...] [ENVIRONMENT ...]): the executable, or what a filter leaves of
# it, as one ctest entry. A filter that leaves nothing fails.
function(alight_gtest_entry entry executable)
  cmake_parse_arguments(ARG "" "" "LABELS;ARGUMENTS;ENVIRONMENT" ${ARGN})
  add_test(NAME ${entry} COMMAND ${executable} ${ARG_ARGUMENTS})
  set_tests_properties(${entry} PROPERTIES TIMEOUT 900 LABELS "${ARG_LABELS}" ENVIRONMENT "${ARG_ENVIRONMENT}"
                                           FAIL_REGULAR_EXPRESSION "Running 0 tests from")
endfunction()

# alight_test(name SOURCES ... DEPENDS ... [TORCH] [WHOLE] [PARTS ...] [LABELS ...]): one test executable a folder, labelled
# unit unless told otherwise. ctest sees each test of it; with TORCH (half a second to load) or WHOLE (costly set-up shared
# by the tests) it sees the executable as one. PARTS are those of its tests that share a set-up, as part=filter: ctest sees
# every part as name.part, and all other tests as name.
function(alight_test name)
  cmake_parse_arguments(ARG "TORCH;WHOLE" "" "SOURCES;DEPENDS;PARTS;LABELS" ${ARGN})
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE ${ARG_DEPENDS} alight_test_support GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name}_tests PRIVATE ALIGHT_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                                   ALIGHT_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if("unit" IN_LIST ARG_LABELS)
    add_dependencies(unit_tests ${name}_tests)
  endif()
  if(ARG_TORCH)
    alight_torch(${name}_tests)
  endif()
  if(NOT ARG_TORCH AND NOT ARG_WHOLE)
    list(LENGTH ARG_LABELS count)
    if(count GREATER 1)  # gtest_discover_tests loses all but the first
      message(FATAL_ERROR "alight_test(${name}): several LABELS need TORCH or WHOLE")
    endif()
    gtest_discover_tests(${name}_tests DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 600 LABELS ${ARG_LABELS})
    return()
  endif()
  # Two threads: enough for what runs on several, and tests that run at the same time do not crowd each other out.
  set(environment GOMP_SPINCOUNT=1000 OMP_NUM_THREADS=2)
  set(others "")
  foreach(part ${ARG_PARTS})
    string(REGEX MATCH "^([^=]+)=(.+)$" _ "${part}")
    alight_gtest_entry(${name}.${CMAKE_MATCH_1} ${name}_tests LABELS ${ARG_LABELS} ENVIRONMENT ${environment}
                       ARGUMENTS --gtest_filter=${CMAKE_MATCH_2})
    list(APPEND others ${CMAKE_MATCH_2})
  endforeach()
  if(others)
    list(JOIN others ":" others)
    set(others --gtest_filter=-${others})
  endif()
  alight_gtest_entry(${name} ${name}_tests LABELS ${ARG_LABELS} ENVIRONMENT ${environment} ARGUMENTS ${others})
endfunction()

# alight_script_test(name LABELS ... COMMAND ... [TIMEOUT seconds]): a test of another kind; exit code 77 means that it
# was skipped and said why.
function(alight_script_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "COMMAND;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_test(NAME ${name} COMMAND ${ARG_COMMAND})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} SKIP_RETURN_CODE 77)
endfunction()
