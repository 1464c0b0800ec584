#include "pictures/chart.hpp"

#include <limits>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

namespace alight {
namespace {

const cv::Scalar kGreen(0, 200, 0);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Where the green curve of a chart lies in a picture of 1001 x 801 px.
cv::Mat drawn(const std::vector<cv::Point2d>& points, bool logarithmic = false) {
  cv::Mat canvas(801, 1001, CV_8UC3, cv::Scalar::all(255));
  draw_chart(canvas, {0, 0, canvas.cols, canvas.rows}, {"title", "epoch", logarithmic, {{kGreen, points}}});
  cv::Mat mask;
  cv::inRange(canvas, kGreen, kGreen, mask);
  return mask;
}

cv::Rect box(const cv::Mat& mask) {
  std::vector<cv::Point> pixels;
  cv::findNonZero(mask, pixels);
  return cv::boundingRect(pixels);
}

bool center_is_drawn(const cv::Mat& mask) {
  const cv::Rect r = box(mask);
  return mask.at<unsigned char>(r.y + r.height / 2, r.x + r.width / 2) != 0;
}

TEST(Chart, LineRisesFromLeftToRight) {
  const cv::Mat mask = drawn({{0, 1}, {10, 3}});
  const cv::Rect r = box(mask);
  EXPECT_GT(r.width, 700);
  EXPECT_GT(r.height, 400);
  EXPECT_TRUE(center_is_drawn(mask));
  const int half = r.width / 2;
  EXPECT_LT(box(mask(cv::Rect(r.x + half, 0, half, mask.rows))).y,
            box(mask(cv::Rect(r.x, 0, half, mask.rows))).y);
}

/// Equal factors are equal steps: 1, 10, 100 lie on a straight line, whose middle is drawn; on a linear axis they would
/// not.
TEST(Chart, WideRangeIsLogarithmic) { EXPECT_TRUE(center_is_drawn(drawn({{0, 1}, {5, 10}, {10, 100}}))); }

TEST(Chart, NarrowRangeIsLinearUnlessAskedFor) {
  EXPECT_TRUE(center_is_drawn(drawn({{0, 1}, {5, 2}, {10, 3}})));
  EXPECT_TRUE(center_is_drawn(drawn({{0, 1}, {5, 2}, {10, 4}}, /*logarithmic=*/true)));
  EXPECT_FALSE(center_is_drawn(drawn({{0, 1}, {5, 2}, {10, 4}})));
}

TEST(Chart, NegativeValuesAreDrawnOnALinearAxis) {
  EXPECT_TRUE(center_is_drawn(drawn({{0, -50}, {5, 0}, {10, 50}}, /*logarithmic=*/true)));
}

TEST(Chart, ValueThatIsNotFiniteLeavesAGap) {
  const cv::Mat mask = drawn({{0, 1}, {1, 1}, {2, kNan}, {3, 1}, {4, 1}});
  EXPECT_FALSE(center_is_drawn(mask));
  EXPECT_GT(box(mask).width, 700);
}

TEST(Chart, SinglePointIsSeen) { EXPECT_GT(cv::countNonZero(drawn({{1, 5}})), 50); }

TEST(Chart, NothingToDrawIsRefused) {
  EXPECT_TRUE(Chart({"title", "epoch", false, {{kGreen, {{0, kNan}}}}}).empty());
  EXPECT_THROW(drawn({}), std::invalid_argument);
}

TEST(Legend, WrapsAndCutsNames) {
  const cv::Rect area(0, 0, 1000, 0);
  const LegendEntry entry{"a run of thirty letters or so", kGreen};
  const int one_line = draw_legend(nullptr, area, {entry});
  EXPECT_EQ(draw_legend(nullptr, area, {{"a", kGreen}, {"b", kGreen}}), one_line);
  EXPECT_GT(draw_legend(nullptr, area, {entry, entry}), one_line);
  cv::Mat canvas(200, 1200, CV_8UC3, cv::Scalar::all(255));
  EXPECT_EQ(draw_legend(&canvas, area, {{std::string(500, 'x'), kGreen}}), one_line);
  EXPECT_EQ(cv::countNonZero(canvas(cv::Rect(1010, 0, 190, 200)).reshape(1) != 255), 0);
  EXPECT_GT(cv::countNonZero(canvas(cv::Rect(0, 0, 1000, 200)).reshape(1) != 255), 1000);
}

}  // namespace
}  // namespace alight
