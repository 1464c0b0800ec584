#pragma once

#include <chrono>
#include <memory>
#include <thread>

#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "infer/onboard/steady_time.hpp"
#include "infer/web/ground_station.hpp"
#include "infer/web/http_server.hpp"
#include "tests/infer/web/connection.hpp"
#include "tests/infer/web/web_reports.hpp"

namespace alight::station {

using Json = nlohmann::json;
constexpr char kToken[] = "a token for tests";

inline GroundStationConfig quick_config() {
  GroundStationConfig config;
  config.address = ":0";
  config.token = kToken;
  config.max_rate_hz = 100;
  return config;
}

inline int port_of(const GroundStation& station) {
  const std::string& url = station.url();
  return std::stoi(url.substr(url.rfind(':') + 1));
}

/// A station on a free port of the loopback, and clients for it.
class GroundStationTest : public testing::Test {
 protected:
  explicit GroundStationTest(const GroundStationConfig& config = quick_config())
      : station_(std::make_unique<GroundStation>(config, mode_, reports::crop(), 5)),
        port_(port_of(*station_)) {}

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_keep_alive(true);
    // The station's threads have the lowest priority: a busy computer lets them wait.
    client.set_read_timeout(100);
    client.set_connection_timeout(100);
    return client;
  }
  Json state() const {
    auto answer = client().Get("/state");
    return answer && answer->status == 200 ? Json::parse(answer->body) : Json();
  }
  /// The state once it is that of a result; the last one asked for if it never is. What the engine could not hand over
  /// while a viewer looked goes with its next message.
  Json state_of(int number) const {
    Json json = state();
    const SteadyTime begin = steady_now();
    while (json["number"] != number && milliseconds(begin, steady_now()) < 60'000) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      station_->on_message(AttitudeSample{});
      json = state();
    }
    return json;
  }
  static httplib::Headers bearer(const std::string& token) { return {{"Authorization", "Bearer " + token}}; }
  int post_mode(const std::string& body, const httplib::Headers& headers) const {
    auto answer = client().Post("/mode", headers, body, "application/json");
    return answer ? answer->status : 0;
  }
  int connect_raw() const { return connect_to(port_); }
  /// Sends bytes and reads until the server closes. @returns the beginning of the answer
  std::string exchange(const std::string& request) const {
    const int socket = connect_raw();
    EXPECT_GE(send(socket, request.data(), request.size(), MSG_NOSIGNAL), 0);
    std::string answer;
    char bytes[4096];
    for (ssize_t count = 0; (count = recv(socket, bytes, sizeof bytes, 0)) > 0;)
      answer.append(bytes, static_cast<std::size_t>(count));
    close(socket);
    return answer;
  }

  ModeSwitch mode_;
  std::unique_ptr<GroundStation> station_;
  int port_;
};

}  // namespace alight::station
