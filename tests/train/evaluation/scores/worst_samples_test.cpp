#include "train/evaluation/scores/worst_samples.hpp"

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"
#include "tests/train/evaluation/evaluation_scenes.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

TEST(WorstSamples, TheWorstAreDrawnInOrder) {
  const test::ScratchFolder scratch;
  const fs::path& dir = scratch.path();
  auto source = test::scenes(3);
  DepthMethods methods;
  // Sample 1 errs most, sample 0 least.
  methods.push_back(test::fake("bad", [](const DepthSample& s, const torch::Tensor&) {
    return s.dense + (s.index == 1 ? 3.0 : s.index == 2 ? 2.0 : 1.0);
  }));
  EvaluationConfig config;
  config.shares = {0.3};
  config.windows_s = {};
  const EvaluationReport report =
      evaluate(methods, source, {{0, "a"}, {1, "a"}, {2, "b"}}, test::scene_rig(), config);
  write_worst_samples(report, *methods[0], source, config, 2, dir);
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(dir)) files.push_back(entry.path().filename().string());
  EXPECT_THAT(files, ::testing::UnorderedElementsAre("01_a_1.png", "02_b_2.png"));
  EXPECT_GE(cv::imread((dir / "01_a_1.png").string()).cols, 5 * 48);
}

TEST(WorstSamples, TheErrorPanelIsBrightWhereTheErrorIsLarge) {
  ErrorPicture picture;
  picture.left = cv::Mat(40, 40, CV_8UC3, cv::Scalar::all(90));
  picture.truth_m = cv::Mat(40, 40, CV_32FC1, cv::Scalar(20));
  picture.fed_m = cv::Mat::zeros(40, 40, CV_32FC1);
  picture.predicted_m = picture.truth_m.clone();
  picture.predicted_m.rowRange(20, 40).setTo(22);
  picture.predicted_m.at<float>(5, 5) = 0;  // unknown: black
  const cv::Mat drawn = draw_errors(picture);
  const int bar_px = 10;
  const cv::Mat panel = drawn(cv::Rect(drawn.cols - 40 - bar_px, drawn.rows - 40, 40, 40));
  const auto brightness = [&](int row, int column) { return cv::norm(panel.at<cv::Vec3b>(row, column)); };
  EXPECT_GT(brightness(30, 20), 1.5 * brightness(10, 20));
  EXPECT_EQ(brightness(5, 5), 0);
}

}  // namespace
}  // namespace alight
