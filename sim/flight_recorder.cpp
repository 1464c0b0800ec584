#include "sim/flight_recorder.hpp"

#include <deque>
#include <functional>
#include <future>
#include <utility>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <spdlog/spdlog.h>

#include "cli/output_folder.hpp"
#include "cli/progress_bar.hpp"
#include "geometry/frames.hpp"
#include "sim/bag_writer.hpp"
#include "sim/message_schedule.hpp"
#include "sim/sensor_messages.hpp"
#include "sim/simulated_flight.hpp"
#include "sim/truth_writer.hpp"

namespace alight::sim {
namespace fs = std::filesystem;
namespace {

/// Frames are made side by side, one a thread, which beats sharing out the rows of one: OpenCV's own threads
/// rest.
class OpenCvOnOneThread {
 public:
  OpenCvOnOneThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OpenCvOnOneThread() { cv::setNumThreads(before_); }
  OpenCvOnOneThread(const OpenCvOnOneThread&) = delete;
  OpenCvOnOneThread& operator=(const OpenCvOnOneThread&) = delete;

 private:
  int before_;
};

/// Puts a finished measurement into the bag; runs on the writing thread, in the order of the schedule.
using WriteStep = std::function<void(BagWriter&)>;

/// Makes the messages of one flight.
class MessageMaker {
 public:
  MessageMaker(const SimulatedFlight& flight, const SensorsConfig& sensors, const Rig& rig,
               const RectifiedRig& rectified, const TruthWriter* truth)
      : flight_(flight), sensors_(sensors), rig_(rig), rectified_(rectified), truth_(truth) {}

  /// Computes a measurement; called from several threads.
  WriteStep make(const ScheduledMessage& message) const {
    switch (message.stream) {
      case SensorStream::kLidar:
        return lidar(message);
      case SensorStream::kCamera:
        return camera(message);
      default:
        return pose(message);
    }
  }

 private:
  std::int64_t on_clock(const ScheduledMessage& message, double clock_offset_s) const {
    return sensors_.start_time_s * kNanosecondsPerSecond + message.measured_ns +
           to_nanoseconds(clock_offset_s);
  }
  std::int64_t receipt(const ScheduledMessage& message) const {
    return sensors_.start_time_s * kNanosecondsPerSecond + message.receive_ns;
  }

  template <class Message>
  WriteStep step(std::string topic, const ScheduledMessage& message, Message content) const {
    return [topic = std::move(topic), t_ns = receipt(message), content = std::move(content)](BagWriter& bag) {
      bag.write(topic, t_ns, content);
    };
  }

  WriteStep pose(const ScheduledMessage& message) const {
    const std::int64_t stamp_ns = on_clock(message, sensors_.pose_clock_offset_s);
    const auto sequence = static_cast<std::uint32_t>(message.index);
    const PoseSensors& sensor = flight_.pose();
    switch (message.stream) {
      case SensorStream::kAttitude:
        return step(kAttitudeTopic, message,
                    attitude_message(sensor.attitude(message.index), stamp_ns, sequence));
      case SensorStream::kImu:
        return step(kImuTopic, message, imu_message(sensor.imu(message.index), stamp_ns, sequence));
      case SensorStream::kPosition:
        return step(kPositionTopic, message,
                    position_message(sensor.position(message.index), stamp_ns, sequence));
      default:
        return step(kHeightTopic, message, height_message(sensor.height_m(message.index)));
    }
  }

  WriteStep lidar(const ScheduledMessage& message) const {
    return step(
        rig_.lidar0->topic, message,
        lidar_message(flight_.lidar().scan(message.index), on_clock(message, sensors_.lidar.clock_offset_s),
                      static_cast<std::uint32_t>(message.index)));
  }

  WriteStep camera(const ScheduledMessage& message) const {
    const std::int64_t stamp_ns = on_clock(message, sensors_.camera.clock_offset_s);
    const StereoExposure exposure = flight_.camera().expose_frame(message.index, truth_ != nullptr);
    if (truth_ != nullptr) {
      truth_->write_frame(stamp_ns, exposure.depth_m,
                          flight_.surface_truth().safe_mask(exposure.depth_m, rectified_.intrinsics,
                                                            exposure.T_world_camera));
    }
    WriteStep left = image(rig_.cam0.topic, "mynteye_left", message, stamp_ns, exposure.left);
    WriteStep right = image(rig_.cam1->topic, "mynteye_right", message, stamp_ns, exposure.right);
    return [left = std::move(left), right = std::move(right)](BagWriter& bag) {
      left(bag);
      right(bag);
    };
  }

  WriteStep image(const std::string& topic, const std::string& frame, const ScheduledMessage& message,
                  std::int64_t stamp_ns, const cv::Mat& pixels) const {
    const auto sequence = static_cast<std::uint32_t>(message.index);
    if (sensors_.camera.format == ImageFormat::kRaw) {
      return step(topic, message, image_message(pixels, frame, stamp_ns, sequence));
    }
    return step(topic + "/compressed", message,
                jpeg_message(pixels, sensors_.camera.jpeg_quality, frame, stamp_ns, sequence));
  }

  const SimulatedFlight& flight_;
  const SensorsConfig& sensors_;
  const Rig& rig_;
  const RectifiedRig& rectified_;
  const TruthWriter* truth_;
};

bool is_heavy(const ScheduledMessage& message) {
  return message.stream == SensorStream::kCamera || message.stream == SensorStream::kLidar;
}

/// Writes the schedule in order while images and scans are made ahead on `threads` threads.
void write_all(const std::vector<ScheduledMessage>& schedule, const MessageMaker& maker, int threads,
               BagWriter& bag, ProgressBar& progress) {
  std::vector<const ScheduledMessage*> heavy;
  for (const ScheduledMessage& message : schedule) {
    if (is_heavy(message)) heavy.push_back(&message);
  }
  std::deque<std::future<WriteStep>> ahead;
  std::size_t next = 0;
  const auto start_more = [&] {
    while (next < heavy.size() && ahead.size() < static_cast<std::size_t>(threads)) {
      ahead.push_back(std::async(std::launch::async, [&maker, m = heavy[next]] { return maker.make(*m); }));
      ++next;
    }
  };
  for (const ScheduledMessage& message : schedule) {
    if (!is_heavy(message)) {
      maker.make(message)(bag);
      continue;
    }
    start_more();
    const WriteStep write = ahead.front().get();
    ahead.pop_front();
    start_more();
    write(bag);
    if (message.stream == SensorStream::kCamera) progress.advance();
  }
}

RecordedFlight count(const std::vector<ScheduledMessage>& schedule) {
  RecordedFlight result;
  for (const ScheduledMessage& message : schedule) {
    const bool camera = message.stream == SensorStream::kCamera;
    result.frames += camera ? 1 : 0;
    result.lidar_packets += message.stream == SensorStream::kLidar ? 1 : 0;
    result.messages += camera ? 2 : 1;
  }
  return result;
}

fs::path with_suffix(const fs::path& folder, const std::string& name, const char* suffix) {
  return folder / (name + suffix);
}

}  // namespace

FlightRecorder::FlightRecorder(const SimConfig& config, const fs::path& output)
    : config_(config), output_(output), rig_(true_rig(load_rig(config.rig), config.sensors)) {
  flyable_rig(rig_, config_.rig);
}

void FlightRecorder::refuse_existing() const {
  for (const FlightConfig& flight : config_.flights) {
    for (const char* suffix : {".bag", ".truth"}) {
      const fs::path path = with_suffix(output_, flight.name, suffix);
      if (!fs::exists(path)) continue;
      throw DataError(path.string() +
                      ": exists already and is not overwritten; remove it or name another folder");
    }
  }
}

RecordedFlight FlightRecorder::record(const FlightConfig& flight) const {
  const RectifiedRig rectified = flyable_rig(rig_, config_.rig);
  const SimulatedFlight simulated(flight, config_, rectified);
  const SensorsConfig sensors = effective(config_.sensors);
  const std::vector<ScheduledMessage> schedule = message_schedule(sensors, simulated.vehicle().duration_s());
  RecordedFlight result = count(schedule);

  std::optional<OutputFolder> truth_folder;
  std::optional<TruthWriter> truth;
  if (config_.recorder.truth) {
    truth_folder.emplace(with_suffix(output_, flight.name, ".truth"));
    truth.emplace(truth_folder->partial(), config_.recorder.truth_png_level);
    truth->write_trajectory(
        simulated, config_.recorder.trajectory_rate_hz,
        sensors.start_time_s * kNanosecondsPerSecond + to_nanoseconds(sensors.pose_clock_offset_s));
    truth->write_description(config_, flight, rig_, result.frames);
  }
  BagWriter bag(with_suffix(output_, flight.name, ".bag"), config_.recorder.compression);
  {
    const OpenCvOnOneThread one_thread;
    const MessageMaker maker(simulated, sensors, rig_, rectified, truth ? &*truth : nullptr);
    ProgressBar progress(flight.name, result.frames, "frames");
    write_all(schedule, maker, config_.recorder.threads, bag, progress);
  }
  if (truth_folder) truth_folder->commit();
  result.bag_bytes = bag.commit();
  return result;
}

}  // namespace alight::sim
