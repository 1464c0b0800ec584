#include "sim/truth/flight_score.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "geometry/rig/rig.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStamp_ns = 1'700'000'000'013'000'000;

/// Truth of one frame: a safe disc of radius 60 around (300, 200) in a 640x400 image.
class FlightScoreTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(truth() / "safe");
    cv::Mat safe = cv::Mat::zeros(400, 640, CV_8UC1);
    cv::circle(safe, {300, 200}, 60, cv::Scalar(255), cv::FILLED);
    cv::imwrite((truth() / "safe" / (std::to_string(kStamp_ns) + ".png")).string(), safe);
    write_rig(0);
  }
  fs::path truth() const { return folder_ / "flight.truth"; }
  fs::path results() const { return folder_ / "results.jsonl"; }

  void write_rig(double timeshift_s) {
    Rig rig = load_rig(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml");
    rig.cam0.timeshift_cam_imu_s = timeshift_s;
    std::ofstream(truth() / "rig.yaml") << format_rig(rig);
  }
  /// A line as alight-infer writes it; (u, v) in the 352x352 crop, which lies at (144, 24).
  static std::string line(double u_px, double v_px, double radius_px, bool accepted,
                          const std::string& source = "image", std::int64_t t_ns = kStamp_ns) {
    return "{\"t_ns\":" + std::to_string(t_ns) + ",\"source\":\"" + source +
           "\",\"accumulation_s\":0.1,\"crop\":{\"x\":144,\"y\":24,\"width\":352,\"height\":352},\"site\":{"
           "\"u_px\":" +
           std::to_string(u_px) + ",\"v_px\":" + std::to_string(v_px) +
           ",\"radius_px\":" + std::to_string(radius_px) +
           ",\"radius_m\":2.5,\"p_world\":[0,0,0],\"accepted\":" + (accepted ? "true" : "false") +
           "},\"reason\":\"\"}\n";
  }
  void write(const std::string& text) const { std::ofstream(results()) << text; }

  const alight::test::ScratchFolder folder_;
};

TEST_F(FlightScoreTest, CountsSafeAndUnsafeSites) {
  write(line(156, 176, 58, true) +           // the safe disc itself
        line(156, 176, 58, false) +          // not accepted: counted as a site only
        line(250, 176, 10, true) +           // centre outside the disc
        line(156, 176, 80, true, "lidar") +  // centre safe, circle too large
        "{\"t_ns\":1,\"source\":\"none\",\"accumulation_s\":1.0,\"site\":null,\"reason\":\"no safe "
        "ground\"}\n");
  const FlightScore score = score_flight(truth(), results());
  EXPECT_EQ(score.all.frames, 5);
  EXPECT_EQ(score.all.sites, 4);
  EXPECT_EQ(score.all.accepted, 3);
  EXPECT_EQ(score.all.safe, 1);
  EXPECT_EQ(score.all.unsafe_centre, 1);
  EXPECT_EQ(score.all.unsafe_circle, 1);
  EXPECT_EQ(score.by_source.at("image").safe, 1);
  EXPECT_EQ(score.by_source.at("lidar").unsafe_circle, 1);
  EXPECT_EQ(score.by_source.at("none").frames, 1);
  EXPECT_THAT(format_score(score), testing::HasSubstr("lidar"));
}

TEST_F(FlightScoreTest, FollowsTheCamerasTimeShift) {
  write_rig(0.05);
  write(line(156, 176, 20, true, "image", kStamp_ns + 50'000'000));
  EXPECT_EQ(score_flight(truth(), results()).all.safe, 1);
}

TEST_F(FlightScoreTest, RefusesResultsOfAnotherFlight) {
  write(line(156, 176, 20, true) + line(156, 176, 20, true, "image", kStamp_ns + 1));
  EXPECT_THAT([&] { score_flight(truth(), results()); },
              testing::ThrowsMessage<DataError>(testing::HasSubstr("results.jsonl:2")));
}

TEST_F(FlightScoreTest, RefusesDamagedLines) {
  for (const std::string& text :
       {std::string("{\"t_ns\": 12\n"), std::string("{}\n"), std::string("[1]\n")}) {
    write(text);
    EXPECT_THAT([&] { score_flight(truth(), results()); },
                testing::ThrowsMessage<DataError>(testing::HasSubstr("results.jsonl:1")));
  }
  write("");
  EXPECT_THROW(score_flight(truth(), results()), DataError);
  EXPECT_THROW(score_flight(truth(), folder_ / "absent.jsonl"), DataError);
  EXPECT_THROW(score_flight(folder_.path(), results()), DataError);
}

TEST(SafeShare, CountsPixelsOutsideTheImageAsUnsafe) {
  const cv::Mat safe(100, 100, CV_8UC1, cv::Scalar(255));
  EXPECT_DOUBLE_EQ(safe_share(safe, 50, 50, 20), 1.0);
  EXPECT_NEAR(safe_share(safe, 0, 50, 20), 0.5, 0.03);
  EXPECT_DOUBLE_EQ(safe_share(safe, -30, 50, 20), 0.0);
  EXPECT_DOUBLE_EQ(safe_share(safe, 10, 10, 0), 1.0);
}

}  // namespace
}  // namespace alight::sim
