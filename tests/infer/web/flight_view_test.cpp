#include "infer/web/flight_view.hpp"

#include <atomic>
#include <thread>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "tests/infer/web/web_reports.hpp"

namespace alight {
namespace {

using Milliseconds = std::chrono::milliseconds;

FlightView make_view(double max_rate_hz = 1000) { return {{reports::crop(), 5, 80}, max_rate_hz}; }

TEST(FlightView, NothingIsShownBeforeTheFirstResult) {
  FlightView view = make_view();
  EXPECT_EQ(view.wait(0, Milliseconds(1)), nullptr);
  EXPECT_EQ(view.find(1), nullptr);
  EXPECT_TRUE(view.history(0, 100).empty());
}

TEST(FlightView, WaitGivesTheLatestResultNotEveryOne) {
  FlightView view = make_view();
  for (int i = 1; i <= 3; ++i) view.add(reports::with_depth(i));
  const auto frame = view.wait(0, Milliseconds(0));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->number(), 3);
  EXPECT_EQ(view.find(3), frame);
  EXPECT_EQ(view.find(2), nullptr);
}

TEST(FlightView, WaitReturnsAsSoonAsAResultComes) {
  FlightView view = make_view();
  view.add(reports::with_depth(1));
  ASSERT_EQ(view.wait(0, Milliseconds(0))->number(), 1);
  std::atomic<bool> seen{false};
  std::thread engine([&] {
    std::this_thread::sleep_for(Milliseconds(30));  // so that mostly somebody waits
    view.add(reports::with_depth(2));
    // What meets a locked door goes with the next message.
    while (!seen) {
      std::this_thread::sleep_for(Milliseconds(5));
      view.add(LogMessage(AttitudeSample{}));
    }
  });
  const SteadyTime begin = steady_now();
  EXPECT_EQ(view.wait(1, Milliseconds(60000))->number(), 2);
  EXPECT_LT(steady_now() - begin, Milliseconds(30000));
  seen = true;
  engine.join();
}

TEST(FlightView, ManyViewersGetOneFrameAPeriodAndShareIt) {
  FlightView view = make_view(0.001);  // one frame in a quarter of an hour
  view.add(reports::with_depth(1));
  const auto first = view.wait(0, Milliseconds(0));
  view.add(reports::with_depth(2));
  EXPECT_EQ(view.wait(0, Milliseconds(0)), first);
  EXPECT_EQ(view.wait(1, Milliseconds(20)), first);  // nothing newer may be shown yet
  EXPECT_EQ(&first->jpeg(Picture::kDepth), &view.find(1)->jpeg(Picture::kDepth));
}

TEST(FlightView, AViewerOfAnotherFlightStartsAnew) {
  FlightView view = make_view();
  view.add(reports::with_depth(1));
  EXPECT_EQ(view.wait(5000, Milliseconds(20000))->number(), 1);
  EXPECT_EQ(view.history(5000, 1).size(), 1U);
}

TEST(FlightView, AViewerWhoComesLateIsNotShownWhatTheLastOneSaw) {
  FlightView view = make_view();
  view.add(reports::with_depth(1));
  ASSERT_EQ(view.wait(0, Milliseconds(0))->number(), 1);
  view.add(reports::with_depth(2));
  std::this_thread::sleep_for(Milliseconds(5));
  EXPECT_EQ(view.wait(0, Milliseconds(0))->number(), 2);
}

TEST(FlightView, HistoryIsWhatTheViewerHasNotSeen) {
  FlightView view = make_view();
  for (int i = 1; i <= 10; ++i) view.add(reports::with_depth(i));
  const auto samples = view.history(4, 9);
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_EQ(samples.front().number, 5);
  EXPECT_EQ(samples.front().t_ns, 5);
  EXPECT_EQ(samples.back().number, 9);
  EXPECT_EQ(*samples.back().stereo.sim_pred, 0.7);
}

TEST(FlightView, ImagesAreFreedByTheEngineOnceNobodyShowsThem) {
  FlightView view = make_view(1e6);
  FrameReport report = reports::with_depth(1);
  const auto users = [pixels = report.depth.left.u] { return pixels->refcount; };
  view.add(report);
  auto shown = view.wait(0, Milliseconds(1000));
  for (int i = 2; i <= 20; ++i) {
    view.add(reports::with_depth(i));
    view.wait(i - 1, Milliseconds(1000));
  }
  EXPECT_EQ(users(), 2);  // a viewer is slow: the report and the test
  shown.reset();
  EXPECT_EQ(users(), 2);  // not yet: the viewer does not free it
  view.add(reports::with_depth(21));
  EXPECT_EQ(users(), 1);
}

TEST(FlightView, HistoryIsBounded) {
  FlightView view = make_view();
  const FrameReport report = reports::without_depth(1);
  for (int i = 0; i < 3000; ++i) view.add(report);
  const auto samples = view.history(0, 3000);
  EXPECT_EQ(samples.size(), 1200U);
  EXPECT_EQ(samples.back().number, 3000);
}

TEST(FlightView, OldFramesAreForgotten) {
  FlightView view = make_view(1e6);
  for (int i = 1; i <= 20; ++i) {
    view.add(reports::with_depth(i));
    ASSERT_EQ(view.wait(i - 1, Milliseconds(1000))->number(), i);
  }
  EXPECT_EQ(view.find(1), nullptr);
  EXPECT_TRUE(view.find(20));
}

TEST(FlightView, EverySensorIsMetered) {
  FlightView view = make_view();
  for (int i = 0; i < 11; ++i) {
    view.add(LogMessage(AttitudeSample{i * 10'000'000, {}}));
    if (i % 2 == 0) view.add(LogMessage(HeightSample{i * 10'000'000, 5}));
  }
  const auto sensors = view.sensors();
  ASSERT_EQ(sensors.size(), 5U);
  EXPECT_EQ(sensors[2].name, "attitude");
  EXPECT_NEAR(sensors[2].rate_hz, 100, 1e-9);
  EXPECT_EQ(sensors[4].name, "height");
  EXPECT_NEAR(sensors[4].rate_hz, 50, 1e-9);
  EXPECT_EQ(sensors[0].count, 0);
  EXPECT_FALSE(sensors[0].age_s);
}

TEST(FlightView, CloseEndsTheWait) {
  FlightView view = make_view();
  std::thread closer([&view] {
    std::this_thread::sleep_for(Milliseconds(30));
    view.close();
  });
  const SteadyTime begin = steady_now();
  view.wait(0, Milliseconds(60000));
  EXPECT_LT(steady_now() - begin, Milliseconds(30000));
  closer.join();
}

TEST(ShownFrame, PicturesHaveTheCropsSizeEvenWithoutAnImage) {
  FlightView view = make_view();
  for (const FrameReport& report :
       {reports::with_depth(1), reports::with_site(2, 5, true), reports::without_depth(3)}) {
    view.add(report);
    const auto frame = view.wait(report.depth.t_ns - 1, Milliseconds(1000));
    for (const Picture picture : {Picture::kLeft, Picture::kDepth, Picture::kSafe}) {
      const std::string& bytes = frame->jpeg(picture);
      const cv::Mat image = cv::imdecode(std::vector<char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
      EXPECT_EQ(image.size(), cv::Size(reports::kWidth_px, reports::kHeight_px));
    }
  }
}

}  // namespace
}  // namespace alight
