#include "train/evaluation/self/self_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "foundation/errors.hpp"
#include "pictures/chart.hpp"

namespace alight {
namespace {

const std::array<cv::Scalar, 6> kCriterionColors{cv::Scalar(180, 119, 31), cv::Scalar(207, 190, 23),
                                                 cv::Scalar(120, 60, 10),  cv::Scalar(44, 160, 44),
                                                 cv::Scalar(40, 39, 214),  cv::Scalar(14, 127, 255)};
const std::array<cv::Scalar, 5> kDecisionColors{cv::Scalar(90, 90, 90), cv::Scalar(10, 90, 10),
                                                cv::Scalar(10, 10, 120), cv::Scalar(200, 60, 200),
                                                cv::Scalar(0, 0, 0)};

cv::Point2d in_percent(double false_accept_rate, double recall) {
  return {100 * false_accept_rate, 100 * recall};
}

/// With points in between, because a chart marks the points of a curve that has few.
Curve curve_of(const std::vector<RocPoint>& roc, const cv::Scalar& color_bgr) {
  constexpr int kParts = 50;
  Curve curve{color_bgr, {}};
  for (std::size_t i = 1; i < roc.size(); ++i) {
    const cv::Point2d from = in_percent(roc[i - 1].false_accept_rate, roc[i - 1].recall);
    const cv::Point2d to = in_percent(roc[i].false_accept_rate, roc[i].recall);
    for (int part = 0; part <= kParts; ++part)
      curve.points.push_back(from + (to - from) * (1.0 * part / kParts));
  }
  return curve;
}

Chart chart_of(const SelfReport& report, const MapList& maps, const std::string& title) {
  const SelfEvaluationConfig& tests = report.config.image.self_evaluation;
  Chart chart;
  chart.title = title;
  chart.x_title = "false accepts, % of the bad maps";
  for (std::size_t i = 0; i < criteria().size(); ++i) {
    const std::vector<RocPoint> roc = roc_curve(pooled(cases_of(maps, criteria()[i], tests)));
    if (roc.empty()) {
      throw DataError(
          "no ROC curve can be drawn: all maps are good, or none is; choose other samples or --good");
    }
    chart.curves.push_back(curve_of(roc, kCriterionColors.at(i)));
  }
  for (std::size_t i = 0; i < decisions().size(); ++i) {
    const DecisionRates rates = rates_of(maps, decisions()[i], tests);
    chart.curves.push_back({kDecisionColors.at(i), {in_percent(rates.false_accept_rate, rates.recall)}});
  }
  return chart;
}

}  // namespace

cv::Mat draw_roc(const SelfReport& report) {
  constexpr int kWidth_px = 1200, kChartHeight_px = 560, kMargin = 40;
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < criteria().size(); ++i)
    legend.push_back({criteria()[i].title, kCriterionColors.at(i)});
  for (std::size_t i = 0; i < decisions().size(); ++i)
    legend.push_back({std::string("dot: ") + decisions()[i].title, kDecisionColors.at(i)});
  const int width = kWidth_px * kChartOversampling;
  const int height = kChartHeight_px * kChartOversampling;
  const cv::Rect legend_area(3 * kMargin, kMargin / 2, width - 6 * kMargin, 0);
  const int top = draw_legend(nullptr, legend_area, legend) + kMargin;
  cv::Mat canvas(top + height, width, CV_8UC3, cv::Scalar::all(255));
  draw_legend(&canvas, legend_area, legend);
  draw_chart(canvas, {0, top, width / 2, height},
             chart_of(report, chosen_maps(report, true), "true accepts, %: the network's maps"));
  draw_chart(canvas, {width / 2, top, width / 2, height},
             chart_of(report, chosen_maps(report, false), "true accepts, %: all maps"));
  cv::Mat figure;
  cv::resize(canvas, figure, {kWidth_px, canvas.rows / kChartOversampling}, 0, 0, cv::INTER_AREA);
  return figure;
}

}  // namespace alight
