#include "sim/record/board_recorder.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "foundation/output_folder.hpp"
#include "foundation/parallel_rows.hpp"
#include "foundation/progress_bar.hpp"
#include "geometry/frames.hpp"
#include "sim/counter_random.hpp"
#include "sim/record/bag_writer.hpp"
#include "sim/record/message_schedule.hpp"
#include "sim/record/simulated_flight.hpp"
#include "sim/sensors/camera_noise.hpp"
#include "sim/sensors/lidar_sensor.hpp"

namespace alight::sim {
namespace fs = std::filesystem;
namespace {

constexpr double kHeight_m = 9;  // of the rig over the grass, which lies behind every board

Vehicle standing(double drift_mps, double duration_s) {
  FlightStart start;
  start.p_world = {0, 0, kHeight_m};
  start.velocity_mps = {0, drift_mps, 0};
  return Vehicle(FlightPath(start, {FlightPhase{duration_s, 0, start.velocity_mps, 0}}), 0);
}

/// One recording: the rig stands, so that each camera's image is rendered once and only its noise differs.
class BoardScene {
 public:
  BoardScene(const BoardSceneConfig& config, const Rig& rig, const RectifiedRig& rectified, int index,
             const Eigen::Isometry3d& T_camera_board)
      : config_(config),
        sensors_(effective(config.sensors)),
        rig_(rig),
        rectified_(rectified),
        seed_(CounterRandom(static_cast<std::uint64_t>(config.seed), RandomStream::kBoardScene)
                  .child(3)
                  .bits(static_cast<std::uint64_t>(index))),
        vehicle_(standing(config.drift_mps, config.duration_s)),
        T_world_camera_(vehicle_.T_world_imu(0) * rectified.T_camera_imu.inverse()),
        world_(board_world(config.board, T_world_camera_ * T_camera_board)),
        renderer_(world_, config.renderer) {
    sensors_.lidar.sensor_seed = config.seed;
    if (config.sensors.noise == Noise::kOff) return;
    const auto bias = [&](std::uint64_t seed) {
      return config.range_bias_m * CounterRandom(seed, RandomStream::kLidarRange).child(1).normal(0);
    };
    sensors_.lidar.range_offset_m += bias(static_cast<std::uint64_t>(config.seed)) + bias(seed_);
  }

  void write(const fs::path& path) const {
    BagWriter bag(path, BagCompression::kNone);
    std::vector<ScheduledMessage> schedule;
    for (const ScheduledMessage& message : message_schedule(sensors_, config_.duration_s)) {
      if (message.stream == SensorStream::kCamera || message.stream == SensorStream::kLidar)
        schedule.push_back(message);
    }
    const std::vector<LidarScan> scans = scan_all(schedule);
    const View left = view(0, T_world_camera_);
    const View right = view(0, T_world_camera_ * rectified_.T_right_camera().inverse());
    for (const ScheduledMessage& message : schedule) {
      if (message.stream == SensorStream::kLidar) {
        bag.write(rig_.lidar0->topic, at(message.receive_ns),
                  lidar_message(scans[static_cast<std::size_t>(message.index)], at(message.measured_ns),
                                static_cast<std::uint32_t>(message.index)));
        continue;
      }
      write_camera(bag, message, rig_.cam0.topic, RandomStream::kLeftImage, left, T_world_camera_);
      write_camera(bag, message, rig_.cam1->topic, RandomStream::kRightImage, right,
                   T_world_camera_ * rectified_.T_right_camera().inverse());
    }
    bag.commit();
  }

 private:
  std::int64_t at(std::int64_t t_ns) const { return sensors_.start_time_s * kNanosecondsPerSecond + t_ns; }

  std::vector<LidarScan> scan_all(const std::vector<ScheduledMessage>& schedule) const {
    const LidarSensor lidar(renderer_, vehicle_,
                            rectified_.T_camera_imu.inverse() * rectified_.T_camera_lidar, sensors_.lidar,
                            seed_);
    int packets = 0;
    for (const ScheduledMessage& message : schedule)
      packets += message.stream == SensorStream::kLidar ? 1 : 0;
    std::vector<LidarScan> scans(static_cast<std::size_t>(packets));
    parallel_rows(config_.renderer.threads, packets,
                  [&](int packet) { scans[static_cast<std::size_t>(packet)] = lidar.scan(packet); });
    return scans;
  }

  View view(std::int64_t t_ns, const Eigen::Isometry3d& T_world_camera) const {
    Eigen::Isometry3d T = T_world_camera;
    T.translation().y() += config_.drift_mps * to_seconds(t_ns);
    View view = renderer_.render_camera(rectified_.intrinsics, T, false);
    if (config_.lens_blur_px > 0) cv::GaussianBlur(view.image, view.image, {}, config_.lens_blur_px);
    return view;
  }

  void write_camera(BagWriter& bag, const ScheduledMessage& message, const std::string& topic,
                    RandomStream stream, const View& still, const Eigen::Isometry3d& T_world_camera) const {
    cv::Mat image =
        config_.drift_mps > 0 ? view(message.measured_ns, T_world_camera).image : still.image.clone();
    expose(image, sensors_.camera, brightness(sensors_.camera, to_seconds(message.measured_ns)),
           CounterRandom(seed_, stream).child(static_cast<std::uint64_t>(message.index)));
    const auto sequence = static_cast<std::uint32_t>(message.index);
    if (sensors_.camera.format == ImageFormat::kRaw) {
      bag.write(topic, at(message.receive_ns),
                image_message(image, topic, at(message.measured_ns), sequence));
    } else {
      bag.write(topic + "/compressed", at(message.receive_ns),
                jpeg_message(image, sensors_.camera.jpeg_quality, topic, at(message.measured_ns), sequence));
    }
  }

  const BoardSceneConfig& config_;
  SensorsConfig sensors_;
  const Rig& rig_;
  const RectifiedRig& rectified_;
  std::uint64_t seed_;
  Vehicle vehicle_;
  Eigen::Isometry3d T_world_camera_;
  World world_;
  Renderer renderer_;
};

}  // namespace

std::vector<fs::path> record_boards(const BoardSceneConfig& config, const fs::path& output) {
  const Rig rig = mounted_rig(config);
  const RectifiedRig rectified = flyable_rig(rig, config.rig);
  const std::vector<Eigen::Isometry3d> poses = board_poses(config, rectified);
  OutputFolder folder(output);
  std::vector<fs::path> bags;
  ProgressBar progress("boards", static_cast<std::int64_t>(poses.size()), "scenes");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string name = fmt::format("board_{:02}.bag", i);
    BoardScene(config, rig, rectified, static_cast<int>(i), poses[i]).write(folder.partial() / name);
    bags.push_back(output / name);
    progress.advance();
  }
  Rig unknown = rig;
  unknown.lidar0->T_camera_lidar = Eigen::Isometry3d::Identity();
  fs::create_directory(folder.partial() / "truth");
  write_file_atomically(folder.partial() / "rig.yaml", format_rig(unknown));
  write_file_atomically(folder.partial() / "truth" / "rig.yaml", format_rig(rig));
  folder.commit();
  return bags;
}

}  // namespace alight::sim
