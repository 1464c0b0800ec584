#include "infer/web/ground_station.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "infer/onboard/steady_time.hpp"
#include "infer/web/http_server.hpp"
#include "tests/infer/web/station.hpp"
#include "tests/infer/web/web_reports.hpp"

namespace alight {
namespace {

using station::GroundStationTest;
using station::Json;
using station::quick_config;

TEST_F(GroundStationTest, ThePageIsWholeAndRunsNoForeignScript) {
  auto answer = client().Get("/");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_NE(answer->body.find("</html>"), std::string::npos);
  EXPECT_EQ(answer->body.find("@NONCE@"), std::string::npos);
  const std::string policy = answer->get_header_value("Content-Security-Policy");
  const std::size_t begin = policy.find("script-src 'nonce-");
  ASSERT_NE(begin, std::string::npos) << policy;
  const std::string nonce = policy.substr(begin + 18, 32);
  EXPECT_NE(answer->body.find("<script nonce=\"" + nonce + "\">"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_EQ(answer->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(answer->get_header_value("X-Content-Type-Options"), "nosniff");
  // Nothing from elsewhere: a vehicle in the field has no internet.
  EXPECT_EQ(answer->body.find("http://"), std::string::npos);
  EXPECT_EQ(answer->body.find("https://"), std::string::npos);
}

TEST_F(GroundStationTest, TheStateBeforeTheFirstResultHasNoFrame) {
  const Json json = state();
  EXPECT_EQ(json["number"], 0);
  EXPECT_TRUE(json["frame"].is_null());
  EXPECT_TRUE(json["age_s"].is_null());
  EXPECT_EQ(json["mode"], "manual");
  EXPECT_EQ(json["sensors"].size(), 5U);
}

TEST_F(GroundStationTest, TheStateIsThatOfTheLatestResult) {
  station_->on_message(AttitudeSample{});
  station_->on_frame(reports::with_site(7'000'000'000, 3, false));
  station_->set_statistics([] {
    RunnerStatistics statistics;
    statistics.images = 12;
    statistics.queued = 4;
    statistics.last_latency_ms = 31;
    statistics.max_latency_ms = 77;
    statistics.dropped["LiDAR packet without pose"] = 9;
    return statistics;
  });
  const Json json = state();
  EXPECT_EQ(json["number"], 1);
  EXPECT_GE(json["age_s"].get<double>(), 0);
  const Json& frame = json["frame"];
  EXPECT_EQ(frame["landing"]["state"], "tracking");
  EXPECT_EQ(frame["landing"]["text"], "tracking 3 of 5");
  EXPECT_EQ(frame["landing"]["depth_m"], 20);
  EXPECT_EQ(frame["result"]["source"], "lidar");
  EXPECT_EQ(frame["result"]["t_ns"], 7'000'000'000);
  EXPECT_EQ(frame["result"]["sim_pred"], 0.7);
  EXPECT_EQ(frame["result"]["site"]["radius_m"], 3);
  EXPECT_EQ(frame["depth"]["min_m"], 20);
  EXPECT_EQ(frame["depth"]["predicted_share"], 0.5);
  EXPECT_EQ(frame["depth"]["interpolated_share"], 0.25);
  EXPECT_EQ(frame["depth"]["unknown_share"], 0.25);
  EXPECT_EQ(frame["health"]["state"], "ok");
  EXPECT_EQ(json["history"], Json::parse(R"([[7.0, "lidar", 0.3, 0.4, 0.8, 0.7, 0.02, 0.05]])"));
  EXPECT_EQ(json["sensors"][2]["count"], 1);
  EXPECT_EQ(json["engine"]["queued"], 4);
  EXPECT_EQ(json["engine"]["last_latency_ms"], 31);
  EXPECT_EQ(json["engine"]["dropped"][0]["reason"], "LiDAR packet without pose");
  EXPECT_EQ(json["engine"]["dropped"][0]["count"], 9);
}

TEST_F(GroundStationTest, EveryLandingStateHasItsName) {
  int number = 0;
  const auto shown = [&](const FrameReport& report) {
    station_->on_frame(report);
    return state_of(++number)["frame"]["landing"]["state"].get<std::string>();
  };
  EXPECT_EQ(shown(reports::with_depth(1)), "looking");
  EXPECT_EQ(shown(reports::with_site(2, 5, true)), "accepted");
  EXPECT_EQ(shown(reports::without_depth(3)), "no_depth");
  const Json json = state();
  EXPECT_EQ(json["frame"]["landing"]["reason"], "no trusted depth: no pose");
  ASSERT_EQ(json["frame"]["health"]["findings"].size(), 1U);
  EXPECT_EQ(json["frame"]["health"]["findings"][0]["fault"], "lost");
  EXPECT_EQ(json["frame"]["health"]["findings"][0]["for_s"], 2);
  FrameReport wandering = reports::with_depth(4);
  wandering.decision.wander = true;
  EXPECT_EQ(shown(wandering), "wandering");
}

TEST_F(GroundStationTest, PicturesDecodeToTheCropsSize) {
  station_->on_frame(reports::with_site(1, 5, true));
  ASSERT_EQ(state()["number"], 1);
  for (const char* name : {"left", "depth", "safe"}) {
    auto answer = client().Get("/image/" + std::string(name) + ".jpg?frame=1");
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->status, 200) << name;
    EXPECT_EQ(answer->get_header_value("Content-Type"), "image/jpeg");
    const std::vector<char> bytes(answer->body.begin(), answer->body.end());
    const cv::Mat image = cv::imdecode(bytes, cv::IMREAD_COLOR);
    EXPECT_EQ(image.size(), cv::Size(reports::kWidth_px, reports::kHeight_px)) << name;
  }
}

TEST_F(GroundStationTest, AViewerWhoWaitsGetsTheNextResult) {
  station_->on_frame(reports::with_depth(1));
  ASSERT_EQ(state()["number"], 1);
  std::atomic<bool> seen{false};
  std::thread engine([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // so that mostly somebody waits
    station_->on_frame(reports::with_depth(2));
    // What meets a locked door goes with the next message.
    while (!seen) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      station_->on_message(AttitudeSample{});
    }
  });
  Json json;
  // Without a result for a second the answer is the last one; a busy computer may take longer.
  for (int i = 0; i < 60 && json["number"] != 2; ++i) {
    const auto answer = client().Get("/state?after=1");
    if (answer) json = Json::parse(answer->body);
  }
  seen = true;
  engine.join();
  EXPECT_EQ(json["number"], 2);
  EXPECT_EQ(json["history"].size(), 1U);
}

TEST_F(GroundStationTest, ViewersAtTheSameTimeSeeTheSame) {
  constexpr int kViewers = 6;
  std::atomic<bool> done{false};
  std::atomic<int> pictures{0};
  std::atomic<int> mistakes{0};
  std::vector<std::thread> viewers;
  for (int i = 0; i < kViewers; ++i) {
    viewers.emplace_back([&] {
      httplib::Client viewer = client();
      std::int64_t seen = 0;
      while (!done) {
        auto answer = viewer.Get("/state?after=" + std::to_string(seen));
        if (!answer || answer->status != 200) {
          ++mistakes;
          continue;
        }
        const Json json = Json::parse(answer->body);
        if (json["number"] == seen) continue;
        seen = json["number"];
        if (json["frame"]["result"]["t_ns"] != seen * 1000) ++mistakes;
        auto picture = viewer.Get("/image/depth.jpg?frame=" + std::to_string(seen));
        if (picture && picture->status == 200) ++pictures;
      }
    });
  }
  const SteadyTime begin = steady_now();
  int frames = 0;
  // At least 40 frames, more on a slow computer whose viewers have not got all they should.
  while (frames < 40 || (pictures <= kViewers && milliseconds(begin, steady_now()) < 60'000)) {
    ++frames;
    station_->on_frame(reports::with_site(frames * 1000, frames, frames >= 5));
    station_->on_message(AttitudeSample{frames * 1000, {}});
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  done = true;
  for (std::thread& viewer : viewers) viewer.join();
  EXPECT_EQ(mistakes, 0);
  EXPECT_GT(pictures, kViewers);
}

TEST_F(GroundStationTest, AClientThatStopsReadingDelaysNeitherTheEngineNorOthers) {
  // After that the server lets such a client go; whoever waited for it would have waited about as long.
  const double given_up_ms = HttpLimits().response_timeout_ms;
  const auto longest_wait_ms = [this] {
    std::vector<int> sockets;
    for (int i = 0; i < 4; ++i) {
      sockets.push_back(connect_raw());
      std::string requests;
      for (int k = 0; k < 200; ++k)
        requests += "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";  // 4 MB of answers
      EXPECT_GT(send(sockets.back(), requests.data(), requests.size(), MSG_NOSIGNAL), 0);
    }
    double longest_ms = 0;
    const FrameReport report = reports::with_site(1, 5, true);
    for (int i = 0; i < 200; ++i) {
      const SteadyTime begin = steady_now();
      station_->on_frame(report);
      longest_ms = std::max(longest_ms, milliseconds(begin, steady_now()));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_GT(state()["number"], 0);
    for (const int socket : sockets) close(socket);
    return longest_ms;
  };
  // A computer with other work may take the processor away for a while; such clients would delay it every time.
  bool delayed = true;
  for (int i = 0; i < 10 && delayed; ++i) delayed = longest_wait_ms() >= given_up_ms / 2;
  EXPECT_FALSE(delayed);
}

TEST_F(GroundStationTest, EndsWhileClientsAreConnected) {
  const int silent = connect_raw();
  const int half = connect_raw();
  EXPECT_GT(send(half, "GET /sta", 8, MSG_NOSIGNAL), 0);
  station_->on_frame(reports::with_depth(1));
  httplib::Client idle = client();
  ASSERT_TRUE(idle.Get("/state"));
  std::atomic<int> asked{0};
  std::thread waiting([&] {
    httplib::Client viewer = client();
    do ++asked;
    while (viewer.Get("/state?after=1"));
  });
  while (asked < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // it waits for the second time
  station_.reset();
  waiting.join();
  close(silent);
  close(half);
}

TEST_F(GroundStationTest, AStationThatNobodyLooksAtEnds) { station_.reset(); }

TEST_F(GroundStationTest, APortInUseSaysWhoseFaultAndWhatToDo) {
  GroundStationConfig config = quick_config();
  config.address = ":" + std::to_string(port_);
  try {
    const GroundStation second(config, mode_, reports::crop(), 5);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_EQ(std::string(error.what()),
              "web address 127.0.0.1:" + std::to_string(port_) +
                  ": another program listens there; end it or name another port (:0 picks a free one)");
  }
}

TEST_F(GroundStationTest, StatisticsAreNotAskedForOnceTakenBack) {
  std::atomic<int> asked{0};
  station_->set_statistics([&asked] {
    ++asked;
    return RunnerStatistics{};
  });
  state();
  station_->set_statistics({});
  const int before = asked;
  EXPECT_EQ(before, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  state();
  EXPECT_EQ(asked, before);
}

}  // namespace
}  // namespace alight
