#include "train/logging/run_plot.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "pictures/chart.hpp"
#include "train/logging/metrics_table.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

const std::string kTotalLoss = "total";
const std::string kLearningRate = "learning_rate";
const std::string kRmse = "rmse_mm_";

struct Run {
  fs::path file;
  std::string name;  // in the legend
  cv::Scalar color_bgr;
  MetricsTable metrics;
};

/// Blue, orange, green, red, purple, brown, pink, grey, olive, cyan.
const std::array<cv::Scalar, kMaxPlottedRuns> kColors{
    cv::Scalar(178, 98, 20), {14, 120, 240}, {60, 145, 30},   {45, 35, 205},  {175, 85, 125},
    {60, 75, 130},           {190, 90, 225}, {120, 120, 120}, {20, 165, 170}, {200, 180, 20}};

std::string last_part(const fs::path& run) {
  const fs::path plain = (run / ".").lexically_normal().parent_path();  // without a trailing slash
  return plain.has_filename() ? plain.filename().string() : run.string();
}

std::vector<Run> read_runs(const std::vector<fs::path>& folders) {
  std::set<std::string> short_names;
  for (const fs::path& folder : folders) short_names.insert(last_part(folder));
  const bool tell_apart = short_names.size() == folders.size();
  std::vector<Run> runs;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / "metrics.csv";
    runs.push_back(
        {file, tell_apart ? last_part(folder) : folder.string(), kColors[runs.size()], read_metrics(file)});
  }
  return runs;
}

bool is_plotted(const std::string& column) {
  return column == kTotalLoss || column == kLearningRate || column.compare(0, kRmse.size(), kRmse) == 0;
}

/// The plotted columns of all runs: loss and learning rate first, then in the order in which they come.
std::vector<std::string> plotted_columns(const std::vector<Run>& runs) {
  std::vector<std::string> columns{kTotalLoss, kLearningRate};
  bool common = false;
  for (const Run& run : runs) {
    for (const std::string& column : run.metrics.columns) {
      if (!is_plotted(column)) continue;
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
      common = common || std::all_of(runs.begin(), runs.end(),
                                     [&](const Run& other) { return other.metrics.has(column); });
    }
  }
  if (!common) {
    throw DataError(
        runs.back().file.string() +
        ": has no column total, learning_rate or rmse_mm_* that all the other runs have too; plot "
        "them apart");
  }
  return columns;
}

std::string chart_title(const std::string& column) {
  if (column == kTotalLoss) return "Total loss";
  if (column == kLearningRate) return "Learning rate";
  std::string what = column.substr(kRmse.size());
  std::replace(what.begin(), what.end(), '_', ' ');
  return "RMSE " + what + " [mm]";
}

Chart make_chart(const std::vector<Run>& runs, const std::string& column) {
  Chart chart{chart_title(column), "epoch", column == kTotalLoss, {}};
  for (const Run& run : runs) {
    if (!run.metrics.has(column)) continue;
    const std::vector<double>& epoch = run.metrics.at("epoch");
    const std::vector<double>& value = run.metrics.at(column);
    Curve curve{run.color_bgr, {}};
    for (std::size_t i = 0; i < epoch.size(); ++i) curve.points.emplace_back(epoch[i], value[i]);
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

std::vector<Chart> make_charts(const std::vector<Run>& runs) {
  std::vector<Chart> charts;
  for (const std::string& column : plotted_columns(runs)) {
    Chart chart = make_chart(runs, column);
    if (!chart.empty()) charts.push_back(std::move(chart));
  }
  if (charts.empty()) throw DataError(runs.front().file.string() + ": holds no finite value to plot");
  return charts;
}

/// The legend above the charts, these in two columns.
cv::Mat draw_figure(const std::vector<Run>& runs, const std::vector<Chart>& charts,
                    const PlotOptions& options) {
  constexpr int kMargin = 40;
  const int width = options.width_px * kChartOversampling;
  const int height = options.chart_height_px * kChartOversampling;
  const int columns = charts.size() == 1 ? 1 : 2;
  const int rows = (static_cast<int>(charts.size()) + columns - 1) / columns;
  std::vector<LegendEntry> legend;
  for (const Run& run : runs) legend.push_back({run.name, run.color_bgr});
  const cv::Rect legend_area(3 * kMargin, kMargin / 2, width - 6 * kMargin, 0);
  const int top = draw_legend(nullptr, legend_area, legend) + kMargin;

  cv::Mat canvas(top + rows * height, width, CV_8UC3, cv::Scalar::all(255));
  draw_legend(&canvas, legend_area, legend);
  for (int i = 0; i < static_cast<int>(charts.size()); ++i) {
    const cv::Rect area(i % columns * width / columns, top + i / columns * height, width / columns, height);
    draw_chart(canvas, area, charts[static_cast<std::size_t>(i)]);
  }
  cv::Mat figure;
  cv::resize(canvas, figure, {options.width_px, canvas.rows / kChartOversampling}, 0, 0, cv::INTER_AREA);
  return figure;
}

}  // namespace

void plot_runs(const std::vector<fs::path>& runs, const fs::path& png, const PlotOptions& options) {
  if (runs.empty() || runs.size() > kMaxPlottedRuns || options.width_px < 400 ||
      options.chart_height_px < 200) {
    throw std::invalid_argument(
        "plot_runs: expected 1 to 10 runs, a width of 400 px and charts of 200 px at least");
  }
  if (!options.overwrite && fs::exists(png)) {
    throw DataError(png.string() +
                    ": exists already and is not overwritten; name another file or give --force");
  }
  const std::vector<Run> read = read_runs(runs);
  const cv::Mat figure = draw_figure(read, make_charts(read), options);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", figure, bytes);
  write_file_atomically(png, std::string(bytes.begin(), bytes.end()));
}

}  // namespace alight
