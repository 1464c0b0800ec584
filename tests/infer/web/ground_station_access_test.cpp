#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/infer/web/station.hpp"

namespace alight {
namespace {

using station::GroundStationTest;
using station::kToken;
using station::quick_config;

TEST_F(GroundStationTest, WhatIsNotThereOrNotProperIsAClientsMistake) {
  station_->on_frame(reports::with_depth(1));
  ASSERT_EQ(state()["number"], 1);
  const auto status = [this](const std::string& path) {
    auto answer = client().Get(path);
    return answer ? answer->status : 0;
  };
  EXPECT_EQ(status("/image/left.jpg?frame=99"), 404);
  EXPECT_EQ(status("/image/right.jpg?frame=1"), 404);
  EXPECT_EQ(status("/image/left.jpg"), 400);
  EXPECT_EQ(status("/image/left.jpg?frame=-1"), 400);
  EXPECT_EQ(status("/image/left.jpg?frame=99999999999999999999999"), 400);
  EXPECT_EQ(status("/state?after=x"), 400);
  EXPECT_EQ(status("/nothing"), 404);
  EXPECT_EQ(status("/../../etc/passwd"), 404);
  EXPECT_EQ(status("/mode"), 404);
  EXPECT_EQ(status("/state?after=" + std::string(9000, '1')), 414);
}

TEST_F(GroundStationTest, TheModeSwitchNeedsTheToken) {
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", {}), 401);
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", bearer("a token for testt")), 401);
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", bearer("")), 401);
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", {{"Authorization", kToken}}), 401);
  EXPECT_EQ(mode_.get(), FlightMode::kManual);
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", bearer(kToken)), 200);
  EXPECT_EQ(mode_.get(), FlightMode::kAutomatic);
  EXPECT_EQ(state()["mode"], "automatic");
  EXPECT_EQ(post_mode(R"({"mode":"manual"})", bearer(kToken)), 200);
  EXPECT_EQ(mode_.get(), FlightMode::kManual);
}

TEST_F(GroundStationTest, AModeThatDoesNotExistChangesNothing) {
  for (const char* body :
       {"", "automatic", "{", "[]", R"({"mode":1})", R"({"mode":"auto"})", R"({"mood":"manual"})"})
    EXPECT_EQ(post_mode(body, bearer(kToken)), 400) << body;
  EXPECT_EQ(mode_.get(), FlightMode::kManual);
}

TEST_F(GroundStationTest, ForeignPagesAreRefusedEvenWithTheToken) {
  auto headers = bearer(kToken);
  headers.emplace("Origin", "http://evil.example");
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", headers), 403);
  auto rebound = bearer(kToken);
  rebound.emplace("Host", "evil.example:" + std::to_string(port_));
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", rebound), 421);
  auto answer = client().Get("/state", {{"Host", "evil.example"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 421);
  EXPECT_EQ(mode_.get(), FlightMode::kManual);
  auto own = bearer(kToken);
  own.emplace("Origin", "http://127.0.0.1:" + std::to_string(port_));
  EXPECT_EQ(post_mode(R"({"mode":"automatic"})", own), 200);
}

TEST_F(GroundStationTest, WhatIsTooLargeOrNoRequestIsRefused) {
  const std::string host = "Host: 127.0.0.1\r\n";
  EXPECT_EQ(exchange("nonsense\r\n\r\n").rfind("HTTP/1.1 400", 0), 0U);
  EXPECT_EQ(exchange("GET /state HTTP/1.1\r\nConnection: close\r\n\r\n").rfind("HTTP/1.1 400", 0), 0U);
  // A line, headers and a body without end: whatever is answered, the connection ends and nothing is kept.
  std::string headers;
  for (int i = 0; i < 5000; ++i) headers += "X-" + std::to_string(i) + ": y\r\n";
  const std::string long_head = exchange("GET /state HTTP/1.1\r\n" + host + headers + "\r\n");
  EXPECT_EQ(long_head.find("200 OK"), std::string::npos);
  const std::string long_body =
      exchange("POST /mode HTTP/1.1\r\n" + host + "Authorization: Bearer " + kToken +
               "\r\nContent-Length: 1000000\r\n\r\n" + std::string(1000000, 'x'));
  EXPECT_EQ(long_body.find("200 OK"), std::string::npos);
  EXPECT_EQ(state()["mode"], "manual");
}

/// At most two connections.
class SmallStationTest : public GroundStationTest {
 protected:
  static GroundStationConfig small() {
    GroundStationConfig config = quick_config();
    config.max_connections = 2;
    return config;
  }
  SmallStationTest() : GroundStationTest(small()) {}
};

TEST_F(SmallStationTest, MoreConnectionsThanAllowedAreTurnedAway) {
  httplib::Client first = client();
  httplib::Client second = client();
  ASSERT_TRUE(first.Get("/state"));
  ASSERT_TRUE(second.Get("/state"));
  auto third = client().Get("/state");
  ASSERT_TRUE(third);
  EXPECT_EQ(third->status, 503);
  first.stop();
  bool served = false;
  for (int i = 0; i < 1000 && !served; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    served = !state().is_null();
  }
  EXPECT_TRUE(served);
}

/// Open to other computers.
class OpenStationTest : public GroundStationTest {
 protected:
  static GroundStationConfig open() {
    GroundStationConfig config = quick_config();
    config.address = "0.0.0.0:0";
    return config;
  }
  OpenStationTest() : GroundStationTest(open()) {}
};

TEST_F(OpenStationTest, NothingOfTheFlightIsSeenWithoutTheToken) {
  const auto status = [this](const char* path, const httplib::Headers& headers) {
    auto answer = client().Get(path, headers);
    return answer ? answer->status : 0;
  };
  EXPECT_EQ(status("/", {}), 200);
  EXPECT_EQ(status("/state", {}), 401);
  EXPECT_EQ(status("/image/left.jpg?frame=1", {}), 401);
  EXPECT_EQ(status("/state", bearer(kToken)), 200);
}

TEST(GroundStation, OtherComputersAreNotServedWithoutAToken) {
  ModeSwitch mode;
  GroundStationConfig config;
  for (const char* address : {"0.0.0.0:0", "[::]:0"}) {
    config.address = address;
    EXPECT_THROW(GroundStation(config, mode, reports::crop(), 5), ConfigError) << address;
  }
  config.token = "short";
  EXPECT_THROW(GroundStation(config, mode, reports::crop(), 5), ConfigError);
}

TEST(GroundStation, AnAddressThatIsNotOursIsADataError) {
  ModeSwitch mode;
  GroundStationConfig config = quick_config();
  config.address = "192.0.2.1:0";  // set aside for documentation: no computer has it
  EXPECT_THROW(GroundStation(config, mode, reports::crop(), 5), DataError);
}

TEST(GroundStation, WithoutATokenARandomOneIsMade) {
  ModeSwitch mode;
  GroundStationConfig config;
  config.address = ":0";
  const GroundStation station(config, mode, reports::crop(), 5);
  EXPECT_EQ(station.token().size(), 32U);
}

}  // namespace
}  // namespace alight
