#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include <httplib.h>

#include "foundation/errors.hpp"
#include "infer/web/listen_address.hpp"

#undef _res  // a macro of <resolv.h>, and a name in Eigen's templates

namespace alight {

/// What a client may ask of a server.
struct HttpLimits {
  int max_connections = 32;               ///< at once; more are turned away with 503
  std::size_t max_request_bytes = 16384;  ///< request line, headers and body together
  int request_timeout_ms = 2000;          ///< for a whole request to arrive, once it has begun
  int response_timeout_ms = 2000;         ///< for a client to take the next part of an answer
  int idle_timeout_ms = 5000;             ///< between two requests of a connection
};

/// cpp-httplib's server for a computer whose main work is something else: its threads have the lowest priority, and
/// limits hold for everything that a client sends, takes or leaves open. (The library by itself takes any number of
/// headers, at any pace, and cannot stop while a client keeps a connection open.) Handlers are registered with Get() and
/// Post() before start().
class HttpServer : private httplib::Server {
 public:
  explicit HttpServer(const HttpLimits& limits);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer() override;

  using httplib::Server::Get;
  using httplib::Server::Post;
  using httplib::Server::set_default_headers;
  using httplib::Server::set_error_handler;
  using httplib::Server::set_pre_routing_handler;

  /// Listens in threads of its own. @returns the port. @throws DataError if the address cannot be had
  int start(const ListenAddress& address);
  /// Ends every connection and waits for the handlers in work.
  void stop();

 private:
  bool process_and_close_socket(socket_t socket) override;
  bool enter(socket_t socket);
  void leave(socket_t socket);
  bool serve(socket_t socket);

  HttpLimits limits_;
  std::mutex mutex_;
  bool stopping_ = false;
  std::set<socket_t> sockets_;  // open connections
  std::thread thread_;
};

}  // namespace alight
