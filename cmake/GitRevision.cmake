# alight_git_revision(target): adds a source file to the target that defines `const char kGitRevision[]`, the commit of
# the source folder. Every build asks git anew, and the file is touched only when the answer changes, so that a build
# without a new commit compiles nothing. The file run as a script (cmake -P) is that question.
if(CMAKE_SCRIPT_MODE_FILE)
  set(revision unknown)
  if(GIT)
    # The ceiling keeps a source folder without .git from passing for a part of a repository above it.
    cmake_path(GET SOURCE PARENT_PATH above)
    set(ENV{GIT_CEILING_DIRECTORIES} ${above})
    execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=40 --exclude=*
                    OUTPUT_VARIABLE answer ERROR_QUIET RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(status EQUAL 0)
      set(revision ${answer})
    endif()
  endif()
  file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
extern const char kGitRevision[];
const char kGitRevision[] = "@revision@";
]])
  return()
endif()

find_program(GIT_PROGRAM git)
function(alight_git_revision target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/git_revision.cpp)
  add_custom_target(${target}_git_revision
    COMMAND ${CMAKE_COMMAND} -D GIT=$<$<BOOL:${GIT_PROGRAM}>:${GIT_PROGRAM}> -D SOURCE=${PROJECT_SOURCE_DIR}
            -D OUTPUT=${output} -P ${PROJECT_SOURCE_DIR}/cmake/GitRevision.cmake
    BYPRODUCTS ${output}
    COMMENT "Asking git for the commit")
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  add_dependencies(${target} ${target}_git_revision)
endfunction()
