// The depth engine over a flight log: a line with the verdict for every left image.
//   depth_of_log flight.bag rig.yaml [network.pt]
#include <cstdio>
#include <exception>
#include <memory>

#include <alight/foundation/command_line.hpp>
#include <alight/infer/depth/depth_engine.hpp>
#include <alight/infer/network/network_predictor.hpp>
#include <alight/infer/replay/replay.hpp>
#include <alight/sensors/stream/flight_log.hpp>

int main(int argc, char** argv) try {
  alight::restart_with_short_spin(argv);  // LibTorch's threads leave the processor to others while they wait
  if (argc < 3) return std::fprintf(stderr, "usage: depth_of_log flight.bag rig.yaml [network.pt]\n"), 2;
  const alight::Rig rig = alight::load_rig(argv[2]);
  const alight::DepthEngineConfig config;
  std::shared_ptr<alight::DepthPredictor> network;  // none: LiDAR alone
  if (argc > 3) network = alight::make_network_predictor(argv[3], alight::engine_rig(config, rig));
  alight::DepthEngine engine(config, rig, network);
  const auto print_results = [&engine] {
    for (const alight::DepthResult& result : engine.take_results()) {
      std::printf("%.3f s  %-8s  %.2f s of LiDAR  %s\n", 1e-9 * static_cast<double>(result.t_ns),
                  alight::name(result.source), result.accumulation_s, result.reason.c_str());
    }
  };
  alight::FlightLog log(argv[1], rig, {});
  for (alight::LogMessage message; log.next(message);) {
    engine.add(message);
    print_results();
  }
  engine.finish();
  print_results();
} catch (const std::exception& e) {
  return std::fprintf(stderr, "error: %s\n", e.what()), 1;
}
