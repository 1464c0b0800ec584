# Cross compilation for a 64-bit ARM computer on any other: clang, and a folder that holds Debian's arm64 packages
# (scripts/ci/build_arm64.sh makes it). Headers, libraries and CMake packages come from that folder alone, programs that run
# while building from this machine, and ctest runs the tests under qemu.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)

set(ALIGHT_ARM64_ROOT ${CMAKE_CURRENT_LIST_DIR}/../build/arm64-root CACHE PATH "Folder of the arm64 packages")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ALIGHT_ARM64_ROOT)
cmake_path(ABSOLUTE_PATH ALIGHT_ARM64_ROOT NORMALIZE OUTPUT_VARIABLE CMAKE_SYSROOT)

set(CMAKE_C_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_EXE_LINKER_FLAGS_INIT -fuse-ld=lld)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -fuse-ld=lld)

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

find_program(ALIGHT_QEMU_PROGRAM NAMES qemu-aarch64-static qemu-aarch64)
if(ALIGHT_QEMU_PROGRAM)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${ALIGHT_QEMU_PROGRAM} -L ${CMAKE_SYSROOT})
endif()
