#include "train/logging/run_plot.hpp"

#include <fstream>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RunPlot : public testing::Test {
 protected:
  fs::path run(const std::string& name, const std::string& metrics) const {
    fs::create_directories(folder_ / name);
    std::ofstream(folder_ / name / "metrics.csv") << metrics;
    return folder_ / name;
  }
  cv::Mat plot(const std::vector<fs::path>& runs, PlotOptions options = {}) const {
    options.overwrite = true;
    plot_runs(runs, png_, options);
    return cv::imread(png_.string(), cv::IMREAD_UNCHANGED);
  }
  std::string refusal(const std::vector<fs::path>& runs) const {
    try {
      plot_runs(runs, png_);
    } catch (const DataError& e) {
      return e.what();
    }
    return "no DataError";
  }
  const test::ScratchFolder folder_;
  const fs::path png_ = folder_ / "curves.png";
};

/// Coloured pixels, which only curves and legend have.
int coloured(const cv::Mat& picture) {
  cv::Mat hsv;
  cv::Mat mask;
  cv::cvtColor(picture, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 60, 60), cv::Scalar(180, 255, 255), mask);
  return cv::countNonZero(mask);
}

TEST_F(RunPlot, PictureHasTheWidthAskedForAndARowForTwoCharts) {
  const cv::Mat one = plot({run("a", "epoch,total\n1,2\n2,1\n")});
  EXPECT_EQ(one.cols, 1600);
  const cv::Mat two = plot({run("a", "epoch,total,rmse_mm_P=0\n1,2,9\n2,1,8\n")});
  EXPECT_EQ(two.rows, one.rows);
  const cv::Mat three = plot({run("a", "epoch,total,learning_rate,rmse_mm_P=0\n1,2,1e-4,9\n2,1,1e-4,8\n")});
  EXPECT_EQ(three.rows, one.rows + PlotOptions().chart_height_px);
  EXPECT_EQ(plot({folder_ / "a"}, {800, 300, true}).cols, 800);
}

TEST_F(RunPlot, EveryRunAddsItsCurve) {
  const fs::path a = run("a", "epoch,total\n1,2\n2,1\n");
  const fs::path b = run("b", "epoch,total\n1,3\n2,0.5\n");
  const cv::Mat both = plot({a, b});
  EXPECT_GT(coloured(both), coloured(plot({a})) + 1000);
}

TEST_F(RunPlot, RunsMayDifferInColumnsAndLength) {
  const fs::path a = run("a", "epoch,total,rmse_mm_P=0\n1,2,9\n2,1,8\n3,1,7\n");
  const fs::path b = run("b", "epoch,seconds,total\n1,3,2\n");
  EXPECT_GT(coloured(plot({a, b})), 0);
}

TEST_F(RunPlot, ColumnWithoutANumberHasNoChart) {
  const int rows = plot({run("a", "epoch,total\n1,2\n")}).rows;
  EXPECT_EQ(plot({run("a", "epoch,total,rmse_mm_P=0,rmse_mm_P=1\n1,2,nan,nan\n")}).rows, rows);
}

TEST_F(RunPlot, ExistingFileIsKept) {
  std::ofstream(png_) << "precious";
  const fs::path a = run("a", "epoch,total\n1,2\n");
  EXPECT_THAT(refusal({a}), HasSubstr(png_.string() + ": exists already"));
  EXPECT_EQ(fs::file_size(png_), 8U);
  EXPECT_FALSE(plot({a}).empty());  // overwrite
}

TEST_F(RunPlot, FaultsNameTheFile) {
  const fs::path a = run("a", "epoch,total\n1,2\n");
  EXPECT_THAT(refusal({a, folder_ / "nowhere"}), HasSubstr((folder_ / "nowhere/metrics.csv").string()));
  EXPECT_THAT(refusal({a, run("damaged", "epoch,total\n1,x\n")}),
              HasSubstr((folder_ / "damaged/metrics.csv").string() + ":2"));
  const std::string apart = refusal({a, run("b", "epoch,rmse_mm_P=0\n1,2\n")});
  EXPECT_THAT(apart, HasSubstr((folder_ / "b/metrics.csv").string()));
  EXPECT_THAT(apart, HasSubstr("no column"));
  EXPECT_THAT(refusal({run("hollow", "epoch,total\n1,nan\n")}), HasSubstr("no finite value"));
  EXPECT_FALSE(fs::exists(png_));
}

TEST_F(RunPlot, NumberOfRunsIsLimited) {
  EXPECT_THROW(plot({}), std::invalid_argument);
  const fs::path a = run("a", "epoch,total\n1,2\n");
  EXPECT_THROW(plot(std::vector<fs::path>(kMaxPlottedRuns + 1, a)), std::invalid_argument);
  EXPECT_NO_THROW(plot(std::vector<fs::path>(kMaxPlottedRuns, a)));
}

}  // namespace
}  // namespace alight
