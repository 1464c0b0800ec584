#include "calibrate/lidar_command.hpp"

#include <cstdio>
#include <optional>

#include "calibrate/lidar/lidar_calibration.hpp"
#include "calibrate/lidar/lidar_report.hpp"
#include "foundation/new_file.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"

namespace alight {
namespace fs = std::filesystem;

int run_lidar(const LidarOptions& options) {
  const auto config = load<LidarCalibrationConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.logs.empty())
    throw ConfigError("--log: is missing; name a recording of the board, once for each");
  if (options.rig.empty())
    throw ConfigError("--rig: is missing; name the rig file with the calibrated camera");
  const Chessboard board = parse_chessboard(options.board, options.square_m);
  const NewFile output(options.output);
  const Rig rig = load_rig(input_file(options.rig));
  std::optional<OutputFolder> report;
  if (!options.report.empty()) report.emplace(options.report);
  const std::vector<fs::path> logs(options.logs.begin(), options.logs.end());
  LidarCalibration calibration;
  {
    ProgressBar progress("boards", static_cast<std::int64_t>(logs.size()), "recordings");
    calibration = calibrate_lidar(logs, rig, board, config, [&] { progress.advance(); });
  }
  std::fputs(format_lidar_report(calibration).c_str(), stdout);
  if (report) {
    write_lidar_report(report->partial(), calibration, board);
    report->commit();
  }
  output.write(format_rig(calibration.rig));
  std::printf("\n%s\n", options.output.c_str());
  return kExitOk;
}

}  // namespace alight
