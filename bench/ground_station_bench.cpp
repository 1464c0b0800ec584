// What watching costs the one who flies: the same hover, as fast as it goes and LiDAR alone, without the ground station,
// with it, and with ten viewers; in turn, so that whatever else the computer does meets all three alike.
//   alight-bench-web [rounds]
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include "foundation/order_statistics.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/steady_time.hpp"
#include "infer/replay/stage_benchmark.hpp"
#include "infer/web/ground_station.hpp"
#include "infer/web/http_server.hpp"

namespace alight {
namespace {

constexpr int kViewers = 10;

/// Does what the page does until told to stop. Viewers sit at other computers: here they get what is left over.
void watch(int port, const std::atomic<bool>& done, std::atomic<int>& frames) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19);
  httplib::Client client("127.0.0.1", port);
  client.set_keep_alive(true);
  std::int64_t seen = 0;
  while (!done) {
    const auto state = client.Get("/state?after=" + std::to_string(seen));
    if (!state || state->status != 200) continue;
    const std::int64_t number = nlohmann::json::parse(state->body)["number"];
    if (number == seen) continue;
    seen = number;
    for (const char* name : {"left", "depth", "safe"})
      client.Get("/image/" + std::string(name) + ".jpg?frame=" + std::to_string(number));
    ++frames;
  }
}

struct Run {
  double wall_s = 0;
  double cpu_s = 0;    ///< of the engine's thread
  double sink_us = 0;  ///< in on_message and on_frame, per result
  int watched = 0;     ///< frames that arrived at a viewer, with all their pictures
};

double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

Run fly(const Rig& rig, const std::vector<LogMessage>& messages, bool with_station, int viewers) {
  LandingPipeline pipeline({}, {}, rig, nullptr);
  ModeSwitch mode;
  std::unique_ptr<GroundStation> station;
  std::vector<std::thread> threads;
  std::atomic<bool> done{false};
  std::atomic<int> frames{0};
  if (with_station) {
    GroundStationConfig config;
    config.address = ":0";
    station = std::make_unique<GroundStation>(config, mode, pipeline.engine().crop(), 5);
    const std::string& url = station->url();
    const int port = std::stoi(url.substr(url.rfind(':') + 1));
    for (int i = 0; i < viewers; ++i) threads.emplace_back([&, port] { watch(port, done, frames); });
  }
  Run run;
  double sink_ms = 0;
  int results = 0;
  const SteadyTime begin = steady_now();
  const double cpu_begin_s = thread_cpu_s();
  for (const LogMessage& message : messages) {
    const SteadyTime before = steady_now();
    if (station) station->on_message(message);
    sink_ms += milliseconds(before, steady_now());
    for (const FrameReport& frame : pipeline.add(message)) {
      const SteadyTime ready = steady_now();
      if (station) station->on_frame(frame);
      sink_ms += milliseconds(ready, steady_now());
      ++results;
    }
  }
  run.cpu_s = thread_cpu_s() - cpu_begin_s;
  run.wall_s = milliseconds(begin, steady_now()) * 1e-3;
  run.sink_us = sink_ms * 1e3 / std::max(results, 1);
  done = true;
  station.reset();
  for (std::thread& thread : threads) thread.join();
  run.watched = frames;
  return run;
}

void compare(int rounds) {
  spdlog::set_level(spdlog::level::warn);
  const Rig rig = load_rig(ALIGHT_SOURCE_DIR "/configs/rigs/paper.yaml");
  const auto messages = synthetic_hover(rig, 15, 5);
  fly(rig, messages, false, 0);  // warms up
  std::vector<double> idle_cpu, idle_wall, watched_cpu, watched_wall;
  for (int round = 1; round <= rounds; ++round) {
    const Run none = fly(rig, messages, false, 0);
    const Run idle = fly(rig, messages, true, 0);
    const Run watched = fly(rig, messages, true, kViewers);
    std::printf(
        "round %d: none %.3f s (CPU %.3f), nobody looks %.3f s (CPU %.3f, sink %.1f us a result), "
        "%d viewers %.3f s (CPU %.3f, sink %.1f us, %.1f frames/s a viewer)\n",
        round, none.wall_s, none.cpu_s, idle.wall_s, idle.cpu_s, idle.sink_us, kViewers, watched.wall_s,
        watched.cpu_s, watched.sink_us, watched.watched / watched.wall_s / kViewers);
    std::fflush(stdout);
    idle_wall.push_back(idle.wall_s / none.wall_s);
    idle_cpu.push_back(idle.cpu_s / none.cpu_s);
    watched_wall.push_back(watched.wall_s / idle.wall_s);
    watched_cpu.push_back(watched.cpu_s / idle.cpu_s);
  }
  std::printf(
      "median of %d rounds, time of the engine's thread: nobody looks / no station: wall %.3f, CPU %.3f; "
      "%d viewers / nobody looks: wall %.3f, CPU %.3f\n",
      rounds, median(idle_wall), median(idle_cpu), kViewers, median(watched_wall), median(watched_cpu));
}

}  // namespace
}  // namespace alight

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 7;
  if (rounds < 1) {
    std::fprintf(stderr, "usage: alight-bench-web [rounds]\n");
    return 2;
  }
  alight::compare(rounds);
  return 0;
}
