# The libraries of others that Alight's libraries use, each an imported target. Included while Alight is built, and by
# alightConfig.cmake on the computer of whoever uses the installed package: every path is that computer's own.
# ALIGHT_MISSING collects what is not there, with the names of Debian's packages.
set(ALIGHT_MISSING)

# alight_package(name debian-package [find_package's arguments...])
macro(alight_package name debian)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    list(APPEND ALIGHT_MISSING "${name} (${debian})")
  endif()
endmacro()

# alight_imported(name debian-package [HEADERS a/b.h...] [SUFFIXES folder...] [LIBRARIES one|other...] [INCLUDES folder...]
# [LINK target...]): alight_<name>, of what is found by header and library names and of what is given. Its headers are
# system headers: our warnings are not theirs.
function(alight_imported name debian)
  cmake_parse_arguments(ARG "" "" "HEADERS;SUFFIXES;LIBRARIES;INCLUDES;LINK" ${ARGN})
  if(TARGET alight_${name})
    return()
  endif()
  set(missing)
  foreach(header IN LISTS ARG_HEADERS)
    string(MAKE_C_IDENTIFIER ALIGHT_FOLDER_OF_${header} variable)
    find_path(${variable} ${header} PATH_SUFFIXES ${ARG_SUFFIXES})
    mark_as_advanced(${variable})
    list(APPEND ARG_INCLUDES ${${variable}})
    if(NOT ${variable})
      string(APPEND missing " ${header}")
    endif()
  endforeach()
  foreach(library IN LISTS ARG_LIBRARIES)
    string(MAKE_C_IDENTIFIER ALIGHT_LIBRARY_${library} variable)
    string(REPLACE "|" ";" names ${library})
    find_library(${variable} NAMES ${names})
    mark_as_advanced(${variable})
    list(APPEND ARG_LINK ${${variable}})
    if(NOT ${variable})
      string(APPEND missing " ${library}")
    endif()
  endforeach()
  if(missing)
    set(ALIGHT_MISSING ${ALIGHT_MISSING} "${name}:${missing} (${debian})" PARENT_SCOPE)
    return()
  endif()
  add_library(alight_${name} INTERFACE IMPORTED)
  target_include_directories(alight_${name} INTERFACE ${ARG_INCLUDES})
  target_link_libraries(alight_${name} INTERFACE ${ARG_LINK})
endfunction()

# Ends the configuration with a list of what is missing.
function(alight_require_libraries)
  if(ALIGHT_MISSING)
    list(JOIN ALIGHT_MISSING "\n  " missing)
    message(FATAL_ERROR "These libraries are missing (Debian's packages in brackets; scripts/setup.sh):\n  ${missing}")
  endif()
endfunction()

alight_package(Threads libc6-dev)
alight_package(Eigen3 libeigen3-dev NO_MODULE)
alight_package(OpenCV libopencv-dev COMPONENTS core imgproc imgcodecs calib3d)
alight_package(yaml-cpp libyaml-cpp-dev)
alight_package(fmt libfmt-dev)  # the one that Debian's spdlog links
alight_package(spdlog libspdlog-dev)
alight_package(CLI11 libcli11-dev)
alight_package(nlohmann_json nlohmann-json3-dev)
alight_imported(opencv libopencv-dev INCLUDES ${OpenCV_INCLUDE_DIRS}
                LINK opencv_core opencv_imgproc opencv_imgcodecs opencv_calib3d)
alight_imported(yaml_cpp libyaml-cpp-dev LINK yaml-cpp)
alight_imported(geographiclib libgeographiclib-dev HEADERS GeographicLib/LocalCartesian.hpp
                LIBRARIES GeographicLib|Geographic)
alight_imported(turbojpeg libturbojpeg0-dev HEADERS turbojpeg.h LIBRARIES turbojpeg)
alight_imported(xxhash libxxhash-dev HEADERS xxhash.h LIBRARIES xxhash)

# rosbag_storage without catkin. Debian keeps the headers of the ROS 2 packages that it leans on one folder deeper.
alight_imported(rosbag "librosbag-storage-dev, libsensor-msgs-dev, libgeometry-msgs-dev, libnav-msgs-dev, libstd-msgs-dev"
                HEADERS rosbag/bag.h sensor_msgs/Image.h geometry_msgs/QuaternionStamped.h nav_msgs/Odometry.h
                        std_msgs/Float32.h pluginlib/class_loader.hpp class_loader/class_loader.hpp
                        rcpputils/shared_library.hpp rcutils/shared_library.h ament_index_cpp/get_package_prefix.hpp
                SUFFIXES pluginlib class_loader rcpputils rcutils ament_index_cpp
                LIBRARIES rosbag_storage roscpp_serialization rostime cpp_common class_loader rcpputils rcutils
                          ament_index_cpp console_bridge tinyxml2)

# Debian's cpp-httplib is compiled with these three, and its classes have other layouts without them; since 0.18 its
# header itself calls OpenSSL.
alight_imported(httplib libcpp-httplib-dev HEADERS httplib.h LIBRARIES cpp-httplib crypto)
if(TARGET alight_httplib)
  target_compile_definitions(alight_httplib INTERFACE CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT
                                                      CPPHTTPLIB_BROTLI_SUPPORT)
endif()

if(ALIGHT_WITH_TORCH)
  alight_package(Torch libtorch-dev)
  # PyPI's wheel brings headers of another fmt than the one that spdlog was compiled with, which have to be found first.
  if(TORCH_INSTALL_PREFIX AND EXISTS ${TORCH_INSTALL_PREFIX}/include/fmt)
    find_path(ALIGHT_FOLDER_OF_fmt fmt/core.h)
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/fmt_of_spdlog)
    file(CREATE_LINK ${ALIGHT_FOLDER_OF_fmt}/fmt ${CMAKE_BINARY_DIR}/fmt_of_spdlog/fmt SYMBOLIC)
    set(fmt_of_spdlog INCLUDES ${CMAKE_BINARY_DIR}/fmt_of_spdlog)
  endif()
  alight_imported(torch libtorch-dev ${fmt_of_spdlog} LINK ${TORCH_LIBRARIES})
  target_compile_features(alight_torch INTERFACE cxx_std_17)
endif()
