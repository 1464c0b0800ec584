// The node as a user runs it, against the replay of the same log: one ROS master, one player, real sockets.
#include <fstream>
#include <map>
#include <memory>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <nlohmann/json.hpp>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/service.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "infer/replay/replay.hpp"
#include "ros/report_messages.hpp"
#include "tests/ros/ros_session.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/tool_runner.hpp"

namespace alight::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kRig = ALIGHT_SOURCE_DIR "/configs/rigs/paper.yaml";
constexpr const char* kNode = ALIGHT_BINARY_DIR "/bin/alight_node";
constexpr double kPatience_s = 60;  ///< a busy computer is no error
/// At the end of a log the replay says that nothing more comes; a live node goes on waiting for it.
constexpr std::size_t kMaxUnfinished = 12;

/// LiDAR alone, with a queue that loses nothing however busy the computer is. @returns the file
fs::path write_config(const fs::path& folder) {
  fs::path path = folder / "infer.yaml";
  std::ofstream(path) << std::ifstream(ALIGHT_SOURCE_DIR "/configs/infer/lidar_only.yaml").rdbuf()
                      << "rig: " << kRig << "\nqueue: {max_images: 1000, max_packets: 100000}\n";
  return path;
}

/// A result line without what differs between runs.
Json comparable(const std::string& line) {
  Json json = Json::parse(line);
  json.erase("stages_ms");
  return json;
}

std::map<std::int64_t, Json> replay_lines(const fs::path& config, const fs::path& bag,
                                          const fs::path& output) {
  const ToolRun run = run_tool("alight-infer --config " + config.string() + " --lidar-only --log " +
                               bag.string() + " --output " + output.string());
  if (run.exit_code != 0) throw std::runtime_error("alight-infer failed: " + run.out);
  std::map<std::int64_t, Json> lines;
  std::ifstream file(output / "results.jsonl");
  for (std::string line; std::getline(file, line);) {
    Json json = comparable(line);
    const std::int64_t t_ns = json.at("t_ns");
    lines[t_ns] = std::move(json);
  }
  return lines;
}

/// The replay's depth as the node would publish it, by image.
class DepthKeeper : public FrameSink {
 public:
  explicit DepthKeeper(const PinholeIntrinsics& intrinsics) : intrinsics_(intrinsics) {}
  void on_frame(const FrameReport& frame) override {
    images[frame.depth.t_ns] = depth_image(frame, intrinsics_, FrameNames{}).data;
  }
  std::map<std::int64_t, std::vector<std::uint8_t>> images;

 private:
  PinholeIntrinsics intrinsics_;
};

/// What the node says, as it comes.
struct Listener {
  explicit Listener(ros::NodeHandle& node) {
    subscribers = {
        node.subscribe("/alight/depth/image", 1000, &Listener::take_depth, this),
        node.subscribe("/alight/depth/camera_info", 1000, &Listener::take_info, this),
        node.subscribe("/alight/result", 1000, &Listener::take_result, this),
        node.subscribe("/alight/mode", 10, &Listener::take_mode, this),
        node.subscribe("/alight/landing_site", 1000, &Listener::take_site, this),
        node.subscribe("/diagnostics", 100, &Listener::take_diagnostics, this),
    };
  }
  bool connected() const {
    return std::all_of(subscribers.begin(), subscribers.end(),
                       [](const ros::Subscriber& s) { return s.getNumPublishers() > 0; });
  }
  void take_depth(const sensor_msgs::Image& image) { depth.push_back(image); }
  void take_info(const sensor_msgs::CameraInfo& info) { infos.push_back(info); }
  void take_result(const std_msgs::String& line) { results.push_back(comparable(line.data)); }
  void take_mode(const std_msgs::String& message) { mode = message.data; }
  void take_site(const geometry_msgs::PoseStamped& site) { sites.push_back(site); }
  void take_diagnostics(const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) statuses[status.name] = status;
  }

  std::vector<ros::Subscriber> subscribers;
  std::vector<sensor_msgs::Image> depth;
  std::vector<sensor_msgs::CameraInfo> infos;
  std::vector<Json> results;
  std::vector<geometry_msgs::PoseStamped> sites;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> statuses;
  std::string mode;
};

std::string value(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const auto& pair : status.values) {
    if (pair.key == key) return pair.value;
  }
  return "no " + key;
}

class NodeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!ros_is_installed()) return;
    scratch_ = std::make_unique<ScratchFolder>();
    folder_ = scratch_->path();
    session_ = std::make_unique<RosSession>(folder_);
    ros::param::set("/use_sim_time", true);
  }
  static void TearDownTestSuite() {
    session_.reset();
    scratch_.reset();
  }
  void SetUp() override {
    if (!ros_is_installed())
      GTEST_SKIP() << "ROS 1's master and player are not installed (scripts/setup.sh --full)";
  }

  static std::vector<std::string> node_command(const std::vector<std::string>& parameters) {
    std::vector<std::string> command = {kNode, "__name:=alight"};
    command.insert(command.end(), parameters.begin(), parameters.end());
    return command;
  }
  /// Starts the node with parameters that it cannot use. @returns what it said
  static std::string refused(const std::vector<std::string>& parameters) {
    Program node(node_command(parameters), folder_ / "refused.log");
    EXPECT_EQ(node.wait(kPatience_s), 2);
    for (const std::string& parameter : parameters)
      ros::param::del("/alight/" + parameter.substr(1, parameter.find(":=") - 1));
    return node.said();
  }
  /// Plays the flight's topics that the node reads, once it has subscribed to all of them.
  static void play(const std::string& rate, const std::string& duration_s) {
    const Rig rig = load_rig(kRig);
    std::vector<std::string> command = {"/usr/bin/rosbag",
                                        "play",
                                        "--quiet",
                                        "--clock",
                                        "--hz=1000",
                                        "--wait-for-subscribers",
                                        "--rate=" + rate,
                                        "--duration=" + duration_s,
                                        (quick_flight() / "quick.bag").string(),
                                        "--topics"};
    for (const auto& [sensor, topic] : sensor_topics(rig, LogConfig{}))
      command.push_back(role(sensor) == LogRole::kImage ? topic + "/compressed" : topic);
    Program player(command, folder_ / "play.log");
    EXPECT_TRUE(wait_for([&] { return !player.running(); }, 2 * kPatience_s)) << player.said();
    EXPECT_EQ(player.wait(1), 0) << player.said();
  }
  static bool set_mode(bool automatic) {
    std_srvs::SetBool call;
    call.request.data = automatic;
    return ros::service::call("/alight/set_mode", call) && call.response.success;
  }

  inline static std::unique_ptr<ScratchFolder> scratch_;
  inline static fs::path folder_;
  inline static std::unique_ptr<RosSession> session_;
};

TEST_F(NodeTest, WrongParametersAreNamedWithTheirCure) {
  EXPECT_THAT(refused({"_lidar_onyl:=true", "_point_step_px:=0"}),
              AllOf(HasSubstr("FATAL"), HasSubstr("lidar_onyl"), HasSubstr("lidar_only"),
                    HasSubstr("point_step_px")));
  EXPECT_THAT(refused({"_rig:=/nowhere/rig.yaml", "_lidar_only:=true"}), HasSubstr("/nowhere/rig.yaml"));
  EXPECT_THAT(refused({"_config:=/nowhere/infer.yaml"}), HasSubstr("/nowhere/infer.yaml"));
}

/// What was heard of the first flight is what the replay says, image for image.
void expect_replayed(Listener& heard, const std::map<std::int64_t, Json>& expected, const DepthKeeper& keeper,
                     const Program& node) {
  ASSERT_FALSE(expected.empty());
  const auto finished = [&] { return heard.results.size() + kMaxUnfinished >= expected.size(); };
  EXPECT_TRUE(wait_for([&] { return finished() && heard.depth.size() == heard.results.size(); }, kPatience_s))
      << node.said();
  EXPECT_LE(heard.results.size(), expected.size());
  ASSERT_EQ(heard.depth.size(), heard.results.size());
  ASSERT_EQ(heard.infos.size(), heard.results.size());
  auto image = expected.begin();
  std::size_t accepted = 0;
  std::size_t with_depth = 0;
  for (std::size_t i = 0; i < heard.results.size(); ++i, ++image) {
    const auto& [t_ns, line] = *image;
    ASSERT_EQ(heard.results[i], line);
    EXPECT_EQ(heard.depth[i].header.stamp.toNSec(), static_cast<std::uint64_t>(t_ns));
    EXPECT_EQ(heard.infos[i].header.stamp, heard.depth[i].header.stamp);
    EXPECT_TRUE(heard.depth[i].data == keeper.images.at(t_ns)) << "depth of image " << i;
    accepted += !line.at("site").is_null() && line.at("site").at("accepted") ? 1 : 0;
    with_depth += line.at("source") != "none" ? 1 : 0;
  }
  EXPECT_GT(with_depth, 5u);
  EXPECT_EQ(heard.sites.size(), accepted);
}

TEST_F(NodeTest, GivesTheReplaysResultsBitForBit) {
  const fs::path bag = quick_flight() / "quick.bag";
  const fs::path file = write_config(folder_);
  const auto expected = replay_lines(file, bag, folder_ / "replayed");
  const auto config = load_config<ReplayConfig>(file);
  const Rig rig = load_rig(config.rig);
  const PinholeIntrinsics intrinsics = engine_rig(config.engine, rig).intrinsics;
  DepthKeeper keeper(intrinsics);
  replay(config, rig, bag, "", nullptr, {}, {&keeper});

  ros::NodeHandle handle;
  Listener heard(handle);
  Program node(node_command({"_config:=" + file.string(), "_lidar_only:=true"}), folder_ / "node.log");
  ASSERT_TRUE(wait_for([&] { return heard.connected() && !heard.mode.empty(); }, kPatience_s)) << node.said();
  EXPECT_EQ(heard.mode, "manual");
  ASSERT_TRUE(set_mode(true));
  EXPECT_TRUE(wait_for([&] { return heard.mode == "automatic"; }, kPatience_s));

  play("0.25", "60");
  expect_replayed(heard, expected, keeper, node);
  EXPECT_EQ(heard.infos.front().K[0], intrinsics.fx_px);
  EXPECT_EQ(heard.depth.front().header.frame_id, "left_camera_optical_frame");

  EXPECT_TRUE(wait_for(
      [&] {
        return value(heard.statuses["/alight: engine"], "images") == std::to_string(heard.results.size());
      },
      kPatience_s));
  EXPECT_EQ(heard.statuses["/alight: sensors"].level, diagnostic_msgs::DiagnosticStatus::OK);
  EXPECT_THAT(value(heard.statuses["/alight: topics"], "/livox/lidar"), HasSubstr("LiDAR"));
  for (const auto& pair : heard.statuses["/alight: engine"].values)
    EXPECT_THAT(pair.key, ::testing::Not(HasSubstr("pushed out")));

  // The log again: the stamps jump back, and with a new engine the results are the same again. A person flies now, so
  // that no site is handed out.
  ASSERT_TRUE(set_mode(false));
  EXPECT_TRUE(wait_for([&] { return heard.mode == "manual"; }, kPatience_s));
  const auto first_round = heard.results;
  heard.results.clear();
  heard.sites.clear();
  play("0.25", "2.5");
  EXPECT_TRUE(wait_for([&] { return heard.results.size() >= 20; }, kPatience_s)) << node.said();
  EXPECT_THAT(node.said(), HasSubstr("jump back"));
  ASSERT_LE(heard.results.size(), first_round.size());
  for (std::size_t i = 0; i < heard.results.size(); ++i) EXPECT_EQ(heard.results[i], first_round[i]);
  EXPECT_TRUE(heard.sites.empty());
}

}  // namespace
}  // namespace alight::test
