# Debian 12's packages only; scripts/setup.sh installs them.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d)
find_package(yaml-cpp REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

# OpenCV's, yaml-cpp's and Embree's headers are system headers: our warnings are not theirs.
function(alight_imported name)
  cmake_parse_arguments(ARG "" "" "INCLUDES;LIBRARIES" ${ARGN})
  add_library(alight_${name} INTERFACE)
  set_target_properties(alight_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(alight_${name} SYSTEM INTERFACE ${ARG_INCLUDES})
  target_link_libraries(alight_${name} INTERFACE ${ARG_LIBRARIES})
  set_property(GLOBAL APPEND PROPERTY ALIGHT_IMPORTED_TARGETS alight_${name})
endfunction()

alight_imported(opencv INCLUDES ${OpenCV_INCLUDE_DIRS}
                LIBRARIES opencv_core opencv_imgproc opencv_imgcodecs opencv_calib3d)
alight_imported(yaml_cpp LIBRARIES yaml-cpp)

find_path(GEOGRAPHICLIB_INCLUDE_DIR GeographicLib/LocalCartesian.hpp REQUIRED)
find_library(GEOGRAPHICLIB_LIBRARY NAMES GeographicLib Geographic REQUIRED)
alight_imported(geographiclib INCLUDES ${GEOGRAPHICLIB_INCLUDE_DIR} LIBRARIES ${GEOGRAPHICLIB_LIBRARY})

# rosbag_storage without catkin. Debian keeps the headers of the ROS 2 packages that it leans on one folder deeper.
set(ROSBAG_INCLUDES)
set(ROSBAG_LIBRARIES)
function(find_ros_header variable header package)
  find_path(ROS_${variable}_DIR ${header} PATH_SUFFIXES ${package} REQUIRED)
  list(APPEND ROSBAG_INCLUDES ${ROS_${variable}_DIR})
  set(ROSBAG_INCLUDES ${ROSBAG_INCLUDES} PARENT_SCOPE)
endfunction()
find_ros_header(ROSBAG rosbag/bag.h "")
find_ros_header(SENSOR_MSGS sensor_msgs/Image.h "")
find_ros_header(GEOMETRY_MSGS geometry_msgs/QuaternionStamped.h "")
find_ros_header(STD_MSGS std_msgs/Float32.h "")
find_ros_header(PLUGINLIB pluginlib/class_loader.hpp pluginlib)
find_ros_header(CLASS_LOADER class_loader/class_loader.hpp class_loader)
find_ros_header(RCPPUTILS rcpputils/shared_library.hpp rcpputils)
find_ros_header(RCUTILS rcutils/shared_library.h rcutils)
find_ros_header(AMENT ament_index_cpp/get_package_prefix.hpp ament_index_cpp)
foreach(library rosbag_storage roscpp_serialization rostime cpp_common class_loader rcpputils rcutils
                ament_index_cpp console_bridge tinyxml2)
  find_library(ROS_${library}_LIBRARY ${library} REQUIRED)
  list(APPEND ROSBAG_LIBRARIES ${ROS_${library}_LIBRARY})
endforeach()
alight_imported(rosbag INCLUDES ${ROSBAG_INCLUDES} LIBRARIES ${ROSBAG_LIBRARIES})

find_path(TURBOJPEG_INCLUDE_DIR turbojpeg.h REQUIRED)
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)
alight_imported(turbojpeg INCLUDES ${TURBOJPEG_INCLUDE_DIR} LIBRARIES ${TURBOJPEG_LIBRARY})

find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
alight_imported(xxhash INCLUDES ${XXHASH_INCLUDE_DIR} LIBRARIES ${XXHASH_LIBRARY})

# Debian's cpp-httplib is compiled with these three, and its classes have other layouts without them.
find_path(HTTPLIB_INCLUDE_DIR httplib.h REQUIRED)
find_library(HTTPLIB_LIBRARY cpp-httplib REQUIRED)
alight_imported(httplib INCLUDES ${HTTPLIB_INCLUDE_DIR} LIBRARIES ${HTTPLIB_LIBRARY})
target_compile_definitions(alight_httplib INTERFACE CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT
                                                    CPPHTTPLIB_BROTLI_SUPPORT)

find_package(embree 3 REQUIRED)
alight_imported(embree INCLUDES ${EMBREE_INCLUDE_DIRS} LIBRARIES ${EMBREE_LIBRARY})

if(ALIGHT_WITH_TORCH)
  find_package(Torch REQUIRED)
  add_library(alight_torch INTERFACE)
  set_target_properties(alight_torch PROPERTIES EXPORT_NAME torch)
  target_link_libraries(alight_torch INTERFACE ${TORCH_LIBRARIES})
  target_compile_features(alight_torch INTERFACE cxx_std_17)
  set_property(GLOBAL APPEND PROPERTY ALIGHT_IMPORTED_TARGETS alight_torch)
  # <torch/torch.h> takes 11 s to parse: parsed once here, reused by every target that calls alight_torch().
  file(WRITE ${PROJECT_BINARY_DIR}/torch_pch.cpp "")
  add_library(alight_torch_pch STATIC ${PROJECT_BINARY_DIR}/torch_pch.cpp)
  target_link_libraries(alight_torch_pch PRIVATE alight_torch)
  target_compile_options(alight_torch_pch PRIVATE ${ALIGHT_PCH_OPTIONS})
  target_precompile_headers(alight_torch_pch PRIVATE <torch/torch.h> <torch/script.h>)

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
