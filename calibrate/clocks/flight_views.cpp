#include "calibrate/clocks/flight_views.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include "calibrate/clocks/grey_image.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/progress_bar.hpp"
#include "geometry/frames.hpp"
#include "sensors/poses/flight_trajectory.hpp"
#include "sensors/stream/flight_log.hpp"

namespace alight {
namespace {

void require_extrinsics(const Rig& rig) {
  if (!rig.lidar0) throw ConfigError("rig: has no lidar0; there is no LiDAR to hold against the cameras");
  if (!rig.cam0.T_camera_imu)
    throw ConfigError(
        "rig: cam0 has no T_cam_imu; without it the flight's poses say nothing about the sensors");
}

bool earlier(const LidarReturn& a, const LidarReturn& b) { return a.t_ns < b.t_ns; }

/// Takes messages apart into what FlightViews keeps.
class Collector {
 public:
  Collector(const Rig& rig, const FlightViewsConfig& config, double step_s)
      : config_(config),
        rectifier_(rig),
        trajectory_(config.max_pose_gap_s),
        step_ns_(to_nanoseconds(step_s)) {
    flight_.rig = rectifier_.rig();
  }

  void add(const StereoFrame& frame) {
    if (frame.t_ns < next_view_ns_) return;
    next_view_ns_ = frame.t_ns + step_ns_;
    ExposureView view{frame.t_ns, rectifier_.rectify_left(to_grey(frame.left)), {}};
    if (!frame.right.empty()) view.right = rectifier_.rectify_right(to_grey(frame.right));
    flight_.views.push_back(std::move(view));
  }
  void add(const LidarPacket& packet) {
    const std::vector<LidarReturn> edges = depth_edges(packet.returns, config_.edges);
    flight_.edges.insert(flight_.edges.end(), edges.begin(), edges.end());
    for (const LidarReturn& point : packet.returns) {
      if (seen_++ % config_.every_nth_point == 0) flight_.points.push_back(point);
    }
  }
  void add(const AttitudeSample& sample) { trajectory_.add(sample); }
  void add(const PositionSample& sample) { trajectory_.add(sample); }
  void add(const HeightSample&) {}

  FlightViews take() {
    flight_.trajectory = trajectory_.trajectory();
    std::stable_sort(flight_.edges.begin(), flight_.edges.end(), earlier);
    std::stable_sort(flight_.points.begin(), flight_.points.end(), earlier);
    return std::move(flight_);
  }

 private:
  FlightViewsConfig config_;
  StereoRectifier rectifier_;
  FlightTrajectory trajectory_;
  FlightViews flight_;
  std::int64_t step_ns_;
  std::int64_t next_view_ns_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t seen_ = 0;
};

}  // namespace

void bind(Binder& b, FlightViewsConfig& c) {
  b.field("view_step_s", c.view_step_s, "between the images that are used", at_least(0));
  b.field("max_views", c.max_views, "images of a long flight, evenly spread", between(1, 10000));
  b.field("every_nth_point", c.every_nth_point, "of the LiDAR's points is used; of its depth edges all are",
          between(1, 10000));
  b.field("max_pose_gap_s", c.max_pose_gap_s, "poses are not interpolated across longer gaps", positive());
  b.section("edges", c.edges, "where the LiDAR's ranges step");
}

FlightViews read_flight_views(const std::filesystem::path& log, const Rig& rig, const LogConfig& log_config,
                              const FlightViewsConfig& config,
                              const std::function<void(std::int64_t, std::int64_t)>& progress) {
  require_extrinsics(rig);
  FlightLog reader(log, rig, log_config);
  const double duration_s = to_seconds(reader.summary().end_ns - reader.summary().begin_ns);
  Collector collector(rig, config, std::max(config.view_step_s, duration_s / config.max_views));
  LogMessage message;
  while (reader.next(message)) {
    std::visit([&](const auto& content) { collector.add(content); }, message);
    if (progress) progress(reader.consumed(), reader.summary().messages);
  }
  return collector.take();
}

FlightViews read_flight_views_with_bar(const std::filesystem::path& log, const Rig& rig,
                                       const LogConfig& log_config, const FlightViewsConfig& config) {
  std::unique_ptr<ProgressBar> bar;  // made when the log's length is known
  std::int64_t shown = 0;
  return read_flight_views(log, rig, log_config, config, [&](std::int64_t read, std::int64_t total) {
    if (!bar) bar = std::make_unique<ProgressBar>(log.filename().string(), total, "messages");
    bar->advance(read - shown);
    shown = read;
  });
}

std::vector<SeenPoint> seen_from(const FlightViews& flight, const ExposureView& view,
                                 const std::vector<LidarReturn>& returns, double window_s,
                                 std::int64_t lidar_shift_ns) {
  std::vector<SeenPoint> seen;
  const auto T_world_imu = flight.trajectory.T_world_imu(view.t_ns);
  if (!T_world_imu) return seen;
  const Eigen::Isometry3d& T_camera_imu = flight.rig.T_camera_imu;
  const Eigen::Isometry3d T_view_world = T_camera_imu * T_world_imu->inverse();
  const Eigen::Isometry3d T_imu_camera = T_camera_imu.inverse();
  const std::int64_t half_ns = to_nanoseconds(0.5 * window_s);
  LidarReturn begin;
  begin.t_ns = view.t_ns - half_ns;
  LidarReturn end;
  end.t_ns = view.t_ns + half_ns;
  const auto first = std::lower_bound(returns.begin(), returns.end(), begin, earlier);
  const auto last = std::upper_bound(first, returns.end(), end, earlier);
  for (auto point = first; point != last; ++point) {
    const auto T_world_imu_own = flight.trajectory.T_world_imu(point->t_ns + lidar_shift_ns);
    if (!T_world_imu_own) continue;
    seen.push_back({flight.rig.T_camera_lidar * point->p_lidar.cast<double>(),
                    T_view_world * *T_world_imu_own * T_imu_camera});
  }
  return seen;
}

}  // namespace alight
