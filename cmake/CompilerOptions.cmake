# Language, warnings, sanitizers and ccache for every target.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Strict IEEE arithmetic: the same log gives the same files on every x86-64 machine. On ARM clang would fuse
# multiplications and additions unless told not to; what the libraries fuse there still differs in the last digits.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -ffp-contract=off)

if(ALIGHT_SANITIZE)
  add_compile_options(-fsanitize=${ALIGHT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ALIGHT_SANITIZE})
endif()

option(ALIGHT_COVERAGE "Count which lines run (gcc)" OFF)
if(ALIGHT_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # A precompiled header needs these sloppiness settings to be cached (ccache manual, "Precompiled headers").
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${CCACHE_PROGRAM})
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # Without a timestamp inside, the same precompiled header hashes the same in every build folder.
  set(ALIGHT_PCH_OPTIONS -Xclang -fno-pch-timestamp)
  find_program(LLD_PROGRAM NAMES ld.lld)
  if(LLD_PROGRAM)
    add_link_options(-fuse-ld=lld)
  endif()
endif()

# A clean build in half the time: the headers and templates that the sources of a target share are compiled once a batch.
# Names in anonymous namespaces must therefore differ within a target. Sources with options of their own stay apart.
option(ALIGHT_UNITY "Compile the sources of a target in batches: quicker as a whole, slower after a change" OFF)
if(ALIGHT_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
endif()

# alight_library(name SOURCES ... DEPENDS ...): one static library a folder, alight::name.
function(alight_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(alight_${name} STATIC ${ARG_SOURCES})
  add_library(alight::${name} ALIAS alight_${name})
  set_target_properties(alight_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(alight_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(alight_${name} PUBLIC cxx_std_17)
  target_link_libraries(alight_${name} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
endfunction()

# alight_torch(target): compile the target with the shared precompiled LibTorch header.
function(alight_torch target)
  target_link_libraries(${target} PRIVATE alight_torch)
  target_compile_options(${target} PRIVATE ${ALIGHT_PCH_OPTIONS})
  target_precompile_headers(${target} REUSE_FROM alight_torch_pch)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL EXECUTABLE)
    # The header is precompiled with -fPIC; -fPIE, an executable's default, does not fit it.
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
endfunction()
