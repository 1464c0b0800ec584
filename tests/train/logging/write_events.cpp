#include <cstdio>
#include <exception>

#include "train/logging/event_file.hpp"

/// Writes the run that read_events.py expects: a run of ten steps that was stopped, then continued after step 5.
namespace {

void write_run(const char* folder) {
  double now_s = 1700000000;
  const auto clock = [&now_s] { return now_s += 1; };
  {
    alight::EventFile first(folder, {}, clock);
    for (int step = 1; step <= 10; ++step) first.scalar("loss/total", step, 1.0 / step);
    first.flush();
  }
  alight::EventFile second(folder, 5, clock);
  for (int step = 6; step <= 8; ++step) second.scalar("loss/total", step, 100 + step);
  second.image("depth", 7, cv::Mat(48, 64, CV_8UC3, cv::Scalar(255, 0, 0)));
  second.histogram("weights", 7, {-1, 0, 0.5F, 3});
  second.histogram("nothing", 7, {});
  second.text("config", 7, "# Run\n**bold** \xc2\xb5");
  second.flush();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_events <folder>\n");
    return 2;
  }
  try {
    write_run(argv[1]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
  return 0;
}
