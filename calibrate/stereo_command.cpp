#include "calibrate/stereo_command.hpp"

#include <cstdio>
#include <optional>

#include <glob.h>
#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "calibrate/clocks/grey_image.hpp"
#include "calibrate/stereo/stereo_calibration.hpp"
#include "calibrate/stereo/stereo_report.hpp"
#include "calibrate/stereo/stereo_views.hpp"
#include "foundation/new_file.hpp"
#include "foundation/output_folder.hpp"
#include "pictures/picture_file.hpp"
#include "sensors/stream/flight_log.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxLogViews = 60;  // of a long recording, evenly spread

std::vector<fs::path> matching(const std::string& option, const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (paths.empty())
    throw ConfigError(option + " " + pattern + ": no such files; quote the pattern and check the folder");
  return paths;
}

cv::Mat read_grey(const fs::path& path) {
  const cv::Mat image = cv::imread(path.string(), cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw DataError(path.string() + ": is no image that can be read");
  return image;
}

std::vector<StereoView> views_of_files(const StereoOptions& options) {
  const std::vector<fs::path> left = matching("--left", options.left);
  const std::vector<fs::path> right = matching("--right", options.right);
  if (left.size() != right.size()) {
    throw ConfigError("--left matches " + std::to_string(left.size()) + " files, --right " +
                      std::to_string(right.size()) + "; they have to be pairs, in the same order by name");
  }
  std::vector<StereoView> views;
  for (std::size_t i = 0; i < left.size(); ++i) {
    StereoView view;
    view.name = left[i].stem().string() + "+" + right[i].stem().string();
    view.left = read_grey(left[i]);
    view.right = read_grey(right[i]);
    views.push_back(std::move(view));
  }
  return views;
}

/// A rig of which only the topics are known; images may have any size.
Rig topics_only(const StereoOptions& options) {
  Rig rig;
  rig.cam0.topic = options.left_topic;
  rig.cam1 = RigCamera();
  rig.cam1->topic = options.right_topic;
  return rig;
}

std::vector<StereoView> views_of_log(const StereoOptions& options) {
  if (options.left_topic.empty() || options.right_topic.empty())
    throw ConfigError("--log needs --left-topic and --right-topic");
  FlightLog log(options.log, topics_only(options), LogConfig(),
                {{Sensor::kLeft, options.left_topic}, {Sensor::kRight, options.right_topic}});
  const std::size_t pairs = static_cast<std::size_t>(log.summary().messages) / 2;
  const std::size_t step = pairs / kMaxLogViews + 1;
  std::vector<StereoView> views;
  LogMessage message;
  for (std::size_t i = 0; log.next(message);) {
    const auto* frame = std::get_if<StereoFrame>(&message);
    if (frame == nullptr || i++ % step != 0) continue;
    StereoView view;
    view.name = "pair " + std::to_string(i - 1);
    view.left = to_grey(frame->left);
    view.right = to_grey(frame->right);
    views.push_back(std::move(view));
  }
  if (views.empty())
    throw DataError(options.log + ": has no pair of images; do the cameras' stamps agree to 2 ms?");
  return views;
}

void write_report(const fs::path& folder, const StereoCalibration& calibration, const std::string& text) {
  write_file_atomically(folder / "report.txt", text);
  for (const StereoView& view : calibration.views) {
    if (!view.used) continue;
    write_picture(folder / ("rectified_" + view.name + ".png"), draw_rectified(calibration, view));
  }
}

}  // namespace

int run_stereo(const StereoOptions& options) {
  const auto config = load<StereoCalibrationConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  const bool files = !options.left.empty() && !options.right.empty();
  if (files == !options.log.empty())
    throw ConfigError("name the images by --left and --right, or a bag by --log");
  const Chessboard board = parse_chessboard(options.board, options.square_m);
  const NewFile output(options.output);
  std::optional<OutputFolder> report;
  if (!options.report.empty()) report.emplace(options.report);
  std::vector<StereoView> views = files ? views_of_files(options) : views_of_log(options);
  find_boards(board, views, config.threads);
  StereoCalibration calibration = calibrate_stereo(board, std::move(views), config);
  calibration.rig.cam0.topic = options.left_topic;
  calibration.rig.cam1->topic = options.right_topic;
  const std::string text = format_stereo_report(calibration);
  std::fputs(text.c_str(), stdout);
  if (std::min(calibration.coverage_left, calibration.coverage_right) < config.min_coverage)
    spdlog::warn(
        "large parts of the image never held the board: lens distortion there is a guess; add views");
  if (report) {
    write_report(report->partial(), calibration, text);
    report->commit();
  }
  output.write(format_rig(calibration.rig));
  std::printf("\n%s\n", options.output.c_str());
  return kExitOk;
}

}  // namespace alight
