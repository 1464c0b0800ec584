#include "sim/record/simulated_log.hpp"

#include <deque>
#include <future>
#include <utility>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <spdlog/spdlog.h>

#include "foundation/output_folder.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/frames.hpp"
#include "sim/record/bag_writer.hpp"
#include "sim/record/message_maker.hpp"
#include "sim/record/message_schedule.hpp"
#include "sim/record/simulated_flight.hpp"
#include "sim/record/truth_writer.hpp"

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

/// The messages of one measurement.
using Made = std::vector<RecordedMessage>;

/// Takes the measurements of one flight; called from several threads.
class Measurements {
 public:
  Measurements(const SimulatedFlight& flight, const SensorsConfig& sensors, const Rig& rig,
               const RectifiedRig& rectified, const TruthWriter* truth)
      : flight_(flight), maker_(sensors, rig), rectified_(rectified), truth_(truth) {}

  Made take(const ScheduledMessage& message) const {
    if (message.stream == SensorStream::kCamera) return camera(message);
    Made made;
    made.push_back(message.stream == SensorStream::kLidar ? maker_.lidar(flight_.lidar(), message)
                                                          : maker_.pose(flight_.pose(), message));
    return made;
  }

 private:
  Made camera(const ScheduledMessage& message) const {
    const StereoExposure exposure = flight_.camera().expose_frame(message.index, truth_ != nullptr);
    if (truth_ != nullptr) {
      truth_->write_frame(maker_.image_stamp_ns(message), exposure.depth_m,
                          flight_.surface_truth().safe_mask(exposure.depth_m, rectified_.intrinsics,
                                                            exposure.T_world_camera));
    }
    auto [left, right] = maker_.images(exposure, message);
    Made made;
    made.push_back(std::move(left));
    made.push_back(std::move(right));
    return made;
  }

  const SimulatedFlight& flight_;
  MessageMaker maker_;
  const RectifiedRig& rectified_;
  const TruthWriter* truth_;
};

void write(const Made& made, BagWriter& bag) {
  for (const RecordedMessage& message : made) bag.write(message);
}

bool is_heavy(const ScheduledMessage& message) {
  return message.stream == SensorStream::kCamera || message.stream == SensorStream::kLidar;
}

/// Writes the schedule in order while images and scans are made ahead on `threads` threads.
void write_all(const std::vector<ScheduledMessage>& schedule, const Measurements& measurements, int threads,
               BagWriter& bag, ProgressBar& progress) {
  std::vector<const ScheduledMessage*> heavy;
  for (const ScheduledMessage& message : schedule) {
    if (is_heavy(message)) heavy.push_back(&message);
  }
  std::deque<std::future<Made>> ahead;
  std::size_t next = 0;
  const auto start_more = [&] {
    while (next < heavy.size() && ahead.size() < static_cast<std::size_t>(threads)) {
      ahead.push_back(
          std::async(std::launch::async, [&measurements, m = heavy[next]] { return measurements.take(*m); }));
      ++next;
    }
  };
  for (const ScheduledMessage& message : schedule) {
    if (!is_heavy(message)) {
      write(measurements.take(message), bag);
      continue;
    }
    start_more();
    const Made made = ahead.front().get();
    ahead.pop_front();
    start_more();
    write(made, bag);
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
    : config_(config), output_(output), rig_(true_rig(load_rig(input_file(config.rig)), config.sensors)) {
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
    const Measurements measurements(simulated, sensors, rig_, rectified, truth ? &*truth : nullptr);
    ProgressBar progress(flight.name, result.frames, "frames");
    write_all(schedule, measurements, config_.recorder.threads, bag, progress);
  }
  if (truth_folder) truth_folder->commit();
  result.bag_bytes = bag.commit();
  return result;
}

}  // namespace alight::sim
