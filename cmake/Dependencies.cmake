# Debian's packages only; scripts/setup.sh installs them.
include(AlightLibraries)
if(ALIGHT_WITH_GROUND)
  find_package(embree 4 QUIET)  # Debian 13's
  if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
  endif()
  alight_imported(embree libembree-dev INCLUDES ${EMBREE_INCLUDE_DIRS} LINK ${EMBREE_LIBRARY})
endif()
alight_require_libraries()

if(ALIGHT_WITH_TORCH)
  # <torch/torch.h> takes 11 s to parse: parsed once here, reused by every target that calls alight_torch().
  file(WRITE ${PROJECT_BINARY_DIR}/torch_pch.cpp "")
  add_library(alight_torch_pch STATIC ${PROJECT_BINARY_DIR}/torch_pch.cpp)
  target_link_libraries(alight_torch_pch PRIVATE alight_torch)
  target_compile_options(alight_torch_pch PRIVATE ${ALIGHT_PCH_OPTIONS})
  target_precompile_headers(alight_torch_pch PRIVATE <torch/torch.h> <torch/script.h>)
endif()

if(ALIGHT_WITH_TORCH AND ALIGHT_WITH_GROUND)
  # The very library that LibTorch links: ONNX's message types may be registered once in a process.
  find_path(ONNX_INCLUDE_DIR onnx/onnx_pb.h REQUIRED)
  find_library(ONNX_PROTO_LIBRARY onnx_proto REQUIRED)
  find_library(PROTOBUF_LIBRARY protobuf REQUIRED)
  add_library(alight_onnx INTERFACE)
  target_include_directories(alight_onnx SYSTEM INTERFACE ${ONNX_INCLUDE_DIR})
  target_compile_definitions(alight_onnx INTERFACE ONNX_NAMESPACE=onnx ONNX_ML=1)
  target_link_libraries(alight_onnx INTERFACE ${ONNX_PROTO_LIBRARY} ${PROTOBUF_LIBRARY})
endif()

if(ALIGHT_WITH_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(ALIGHT_WITH_BENCH)
  find_package(benchmark REQUIRED)
endif()
