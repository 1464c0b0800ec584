// Serves the ground-station page of a hover in real time until standard input ends, for tests that look at it with a
// browser: serve_hover [address [token]]. Prints the URL.
#include <cstdio>
#include <exception>
#include <memory>
#include <thread>

#include <poll.h>
#include <unistd.h>

#include "infer/onboard/engine_runner.hpp"
#include "infer/web/ground_station.hpp"
#include "tests/infer/fakes.hpp"
#include "tests/infer/web/hover_flight.hpp"

namespace alight {
namespace {

bool input_ended() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char byte = 0;
  return poll(&input, 1, 0) > 0 && read(STDIN_FILENO, &byte, 1) <= 0;
}

void serve(const GroundStationConfig& config) {
  HoverFlight flight;
  // Wrong from the image alone, right with LiDAR: as a network is that has to wait for its points.
  const auto predictor = std::make_shared<fakes::FakePredictor>([](int points) {
    return points > 3000 ? HoverFlight::kHeight_m + 0.02 : HoverFlight::kHeight_m * 1.3;
  });
  auto pipeline = flight.pipeline(predictor);
  ModeSwitch mode;
  GroundStation station(config, mode, pipeline->engine().crop(), SiteTrackerConfig{}.confirm_frames);
  std::printf("%s\n", station.url().c_str());
  std::fflush(stdout);
  EngineRunner runner({}, std::move(pipeline), {&station});
  station.set_statistics([&runner] { return runner.statistics(); });
  const SteadyTime begin = steady_now();
  while (!input_ended()) {
    LogMessage message = flight.next();
    std::this_thread::sleep_until(begin + std::chrono::nanoseconds(HoverFlight::time_ns(message)));
    runner.push(std::move(message));
  }
  station.set_statistics({});
  runner.finish();
}

}  // namespace
}  // namespace alight

int main(int argc, char** argv) {
  alight::GroundStationConfig config;
  config.address = argc > 1 ? argv[1] : ":0";
  if (argc > 2) config.token = argv[2];
  try {
    alight::serve(config);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "serve_hover: %s\n", error.what());
    return 1;
  }
  return 0;
}
