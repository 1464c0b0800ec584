#include "infer/recorder/explanation.hpp"

#include <memory>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/infer/recorder/recorded_flight.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using fakes::kStart_ns;
using ::testing::Test;

class ExplanationOf : public Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<test::ScratchFolder>();
    folder_ = scratch_->path() / "record";
    RecorderConfig config;
    config.max_waiting = 1000;
    fakes::record_flight(folder_, config, 1.5);
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static std::string text_at(double s) { return explain(folder_, kStart_ns + to_nanoseconds(s)).text; }
  static void expect_in(const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }

  inline static std::unique_ptr<test::ScratchFolder> scratch_;
  inline static fs::path folder_;
};

TEST_F(ExplanationOf, AnAcceptedSiteSaysByWhat) {
  const std::string text = text_at(1.6);
  expect_in("landing site accepted", text);
  expect_in("sensors: ok", text);
  expect_in("depth: fallback, LiDAR alone; 1.0", text);
  expect_in("m, more than 2.00 m wanted", text);
  expect_in("frames in a row, 5 wanted", text);
}

TEST_F(ExplanationOf, AMissingSiteSaysWhy) {
  const std::string text = text_at(2.4);
  expect_in("no landing site:", text);
  expect_in("sensors: failed\n  lidar lost: no message for 0.", text);
}

TEST_F(ExplanationOf, ThePictureShowsTheFourPanels) {
  const cv::Mat picture = explain(folder_, kStart_ns + to_nanoseconds(1.6)).picture;
  EXPECT_GT(picture.cols, 4 * 160);
  EXPECT_GT(picture.rows, 144);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture(cv::Rect(0, 24, 160, 144)), mean, deviation);
  EXPECT_GT(deviation[0], 20);  // the textured ground
}

TEST_F(ExplanationOf, AMomentIsSecondsFromTheBeginOrNanoseconds) {
  const std::int64_t first_ns = kStart_ns + to_nanoseconds(0.045);
  EXPECT_EQ(moment_of(folder_, "1.5"), first_ns + to_nanoseconds(1.5));
  EXPECT_EQ(moment_of(folder_, std::to_string(kStart_ns)), kStart_ns);
  EXPECT_THROW(moment_of(folder_, "soon"), ConfigError);
  EXPECT_THROW(explain(folder_, kStart_ns), DataError);  // before the first result
}

TEST_F(ExplanationOf, TheToolWritesThePicture) {
  const fs::path picture = folder_ / "why.png";
  EXPECT_EQ(run_explain(folder_, "1.5", picture), 0);
  EXPECT_FALSE(cv::imread(picture.string()).empty());
}

}  // namespace
}  // namespace alight
