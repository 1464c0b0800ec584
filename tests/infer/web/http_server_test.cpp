#include "infer/web/http_server.hpp"

#include <cerrno>
#include <chrono>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/infer/web/connection.hpp"

namespace alight {
namespace {

TEST(HttpServer, StopsWithoutWaitingForItsClients) {
  constexpr int kHour_ms = 3'600'000;
  HttpLimits limits;
  limits.idle_timeout_ms = limits.request_timeout_ms = limits.response_timeout_ms = kHour_ms;
  HttpServer server(limits);
  const std::string large(50'000'000, 'x');
  server.Get("/large", [&large](const httplib::Request&, httplib::Response& response) {
    response.set_content(large, "text/plain");
  });
  const int port = server.start({"127.0.0.1", 0});
  std::vector<int> sockets;
  for (const char* begun : {"", "GET /la", "GET /large HTTP/1.1\r\n\r\n"}) {
    sockets.push_back(connect_to(port));
    const std::string text = begun;
    EXPECT_EQ(send(sockets.back(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  // The first bytes of the answer have come: the server is in the middle of it.
  char byte = 0;
  EXPECT_EQ(recv(sockets.back(), &byte, 1, 0), 1);
  const auto begin = std::chrono::steady_clock::now();
  server.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(2));
  for (const int socket : sockets) close(socket);
}

TEST(HttpServer, EndsARequestThatDoesNotArriveInTime) {
  HttpLimits limits;
  limits.request_timeout_ms = 50;
  HttpServer server(limits);
  const int socket = connect_to(server.start({"127.0.0.1", 0}));
  // A busy computer may send it after the server has given up, which resets the connection.
  const bool sent = send(socket, "GET /", 5, MSG_NOSIGNAL) == 5;
  char bytes[1024];
  ssize_t count = 0;
  while (sent && (count = recv(socket, bytes, sizeof bytes, 0)) > 0) continue;
  EXPECT_TRUE(count == 0 || errno == ECONNRESET) << "not closed by the server";
  close(socket);
}

}  // namespace
}  // namespace alight
