# Reports for people.
#   cmake --build --preset release --target api_docs        what the headers say: build/release/html (doxygen)
#   cmake --build --preset coverage --target coverage       which lines the unit tests run: build/coverage/coverage (gcovr)
# Each is there where its program is installed (scripts/setup.sh --nightly).
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(DOXYGEN_PROJECT_BRIEF "${PROJECT_DESCRIPTION}")
  set(DOXYGEN_USE_MDFILE_AS_MAINPAGE README.md)
  set(DOXYGEN_FILE_PATTERNS *.hpp *.md)
  set(DOXYGEN_EXTRACT_ALL YES)
  set(DOXYGEN_QUIET YES)
  doxygen_add_docs(api_docs README.md docs foundation pictures geometry sensors calibrate dataset sim models losses train infer
                   closed_loop ros WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Writing html/index.html")
endif()

find_program(GCOVR_PROGRAM gcovr)
if(ALIGHT_COVERAGE AND GCOVR_PROGRAM)
  set(report ${PROJECT_BINARY_DIR}/coverage)
  add_custom_target(coverage
    COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${PROJECT_BINARY_DIR} --parallel 2 --label-regex unit --output-on-failure
    COMMAND ${CMAKE_COMMAND} -E make_directory ${report}
    COMMAND ${GCOVR_PROGRAM} --root ${PROJECT_SOURCE_DIR} --exclude tests/ --exclude build/ --print-summary
            --html-details ${report}/index.html ${PROJECT_BINARY_DIR}
    DEPENDS unit_tests COMMENT "Writing coverage/index.html" VERBATIM)
endif()
