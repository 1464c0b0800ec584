#include "sensors/messages/livox_custom_msg.hpp"

#include <rosbag/view.h>

#include <gtest/gtest.h>

#include "tests/sensors/test_flight.hpp"
#include "tests/support/programs.hpp"

namespace alight::testing {
namespace {

TEST(LivoxCustomMsg, SurvivesABag) {
  const ScratchFolder folder;
  const std::string path = (folder.path() / "livox.bag").string();
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.write("/livox/lidar", ros_time(kStart_ns), livox_message(kStart_ns, 5));
  }
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 1u);
  EXPECT_EQ(view.begin()->getDataType(), "livox_ros_driver/CustomMsg");
  EXPECT_EQ(view.begin()->getMD5Sum(), "e4d6829bdfe657cb6c21a746c86b21a6");
  const auto message = view.begin()->instantiate<livox_ros_driver::CustomMsg>();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->points.size(), 5u);
  EXPECT_EQ(message->points[4].reflectivity, 4);
}

/// ROS's own Python reader decodes by the definition text, and computes the checksum of that text.
TEST(LivoxCustomMsg, RosPythonReadsItAndAgreesOnTheChecksum) {
  if (!test::python_has("rosbag, genpy.dynamic")) GTEST_SKIP() << "needs python3-rosbag";
  const ScratchFolder folder;
  const std::string path = (folder.path() / "livox.bag").string();
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.write("/livox/lidar", ros_time(kStart_ns), livox_message(kStart_ns, 5));
  }
  write_bytes(
      folder.path() / "read.py",
      "import sys, rosbag, genpy.dynamic\n"
      "bag = rosbag.Bag(sys.argv[1])\n"
      "connection = next(iter(bag._get_connections()))\n"
      "generated = genpy.dynamic.generate_dynamic(connection.datatype, connection.msg_def)\n"
      "assert generated['livox_ros_driver/CustomMsg']._md5sum == 'e4d6829bdfe657cb6c21a746c86b21a6'\n"
      "assert generated['livox_ros_driver/CustomPoint']._md5sum == '109a3cc548bb1f96626be89a5008bd6d'\n"
      "topic, message, t = next(bag.read_messages())\n"
      "assert message.point_num == 5 and len(message.points) == 5\n"
      "assert message.points[0].x == 10.0 and message.points[4].reflectivity == 4\n");
  const test::CommandRun read =
      test::run_command("/usr/bin/python3 " + (folder.path() / "read.py").string() + " " + path);
  EXPECT_EQ(read.exit_code, 0) << read.out;
}

}  // namespace
}  // namespace alight::testing
