#include "infer/web/http_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "foundation/errors.hpp"
#include "infer/onboard/steady_time.hpp"

namespace alight {
namespace {

constexpr int kLowestPriority = 19;
constexpr char kBusy[] =
    "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 2\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

/// Of this thread alone: Linux takes a thread's id for a process's here.
void lower_priority() { setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowestPriority); }

bool wait_for(socket_t socket, short events, int timeout_ms) {
  pollfd entry{socket, events, 0};
  int ready = 0;
  do ready = poll(&entry, 1, std::max(timeout_ms, 0));
  while (ready < 0 && errno == EINTR);
  return ready > 0;
}

/// Two connected addresses as text.
using AddressGetter = int (*)(int, sockaddr*, socklen_t*);
void describe(socket_t socket, AddressGetter get, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (get(socket, generic, &size) != 0) return;
  if (getnameinfo(generic, size, host.data(), host.size(), service.data(), service.size(),
                  NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return;
  ip = host.data();
  port = std::atoi(service.data());
}

/// One connection, read and written within the limits.
class LimitedStream : public httplib::Stream {
 public:
  LimitedStream(socket_t socket, const HttpLimits& limits) : socket_(socket), limits_(limits) {}

  /// Waits for the next request. @returns false when none comes
  bool next_request() {
    left_ = limits_.max_request_bytes;
    if (begin_ == end_ && !wait_for(socket_, POLLIN, limits_.idle_timeout_ms)) return false;
    deadline_ = steady_now() + std::chrono::milliseconds(limits_.request_timeout_ms);
    return true;
  }

  bool is_readable() const override { return begin_ != end_ || wait_for(socket_, POLLIN, remaining_ms()); }
  bool is_writable() const override { return wait_for(socket_, POLLOUT, limits_.response_timeout_ms); }

  ssize_t read(char* target, std::size_t size) override {
    if (begin_ == end_ && !fill()) return -1;
    const std::size_t count = std::min({size, end_ - begin_, left_});
    if (count == 0) return -1;
    std::memcpy(target, buffer_.data() + begin_, count);
    begin_ += count;
    left_ -= count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* source, std::size_t size) override {
    if (!is_writable()) return -1;
    return send(socket_, source, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    describe(socket_, getpeername, ip, port);
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    describe(socket_, getsockname, ip, port);
  }
  socket_t socket() const override { return socket_; }

 private:
  int remaining_ms() const { return static_cast<int>(milliseconds(steady_now(), deadline_)); }
  bool fill() {
    if (left_ == 0 || !wait_for(socket_, POLLIN, remaining_ms())) return false;
    const ssize_t count = recv(socket_, buffer_.data(), buffer_.size(), 0);
    begin_ = 0;
    end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
    return count > 0;
  }

  socket_t socket_;
  const HttpLimits& limits_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;  // of what was received and not yet read
  std::size_t end_ = 0;
  std::size_t left_ = 0;  // that this request may still have
  SteadyTime deadline_;
};

using Note = std::function<void(httplib::Request&)>;

/// One request by the library's own member function, which in Debian 12 asks the stream for both addresses itself.
[[maybe_unused]] bool process(httplib::Server& server, LimitedStream& stream, bool& closed, const Note& note,
                              bool (httplib::Server::*member)(httplib::Stream&, bool, bool&, const Note&)) {
  return (server.*member)(stream, false, closed, note);
}

/// The same by Debian 13's, which is told them.
[[maybe_unused]] bool process(httplib::Server& server, LimitedStream& stream, bool& closed, const Note& note,
                              bool (httplib::Server::*member)(httplib::Stream&, const std::string&, int,
                                                              const std::string&, int, bool, bool&,
                                                              const Note&)) {
  std::string remote_ip;
  std::string local_ip;
  int remote_port = 0;
  int local_port = 0;
  stream.get_remote_ip_and_port(remote_ip, remote_port);
  stream.get_local_ip_and_port(local_ip, local_port);
  return (server.*member)(stream, remote_ip, remote_port, local_ip, local_port, false, closed, note);
}

/// Nothing more will be sent. What the client still sends is taken in for a moment: a socket that is closed with bytes
/// unread resets the connection, and the client would lose the answer.
void part(socket_t socket) {
  constexpr int kPatience_ms = 100;
  std::array<char, 4096> unwanted{};
  const SteadyTime end = steady_now() + std::chrono::milliseconds(kPatience_ms);
  shutdown(socket, SHUT_WR);
  while (wait_for(socket, POLLIN, static_cast<int>(milliseconds(steady_now(), end)))) {
    if (steady_now() >= end || recv(socket, unwanted.data(), unwanted.size(), 0) <= 0) return;
  }
}

std::string cannot_listen(const ListenAddress& address, int error) {
  const std::string begin = "web address " + address.text() + ": ";
  switch (error) {
    case EADDRINUSE:
      return begin + "another program listens there; end it or name another port (:0 picks a free one)";
    case EACCES:
      return begin + "ports below 1024 need root; name a higher one";
    case EADDRNOTAVAIL:
      return begin + "this computer has no such address; 0.0.0.0 stands for all that it has";
    case 0:
      return begin + "the host name is not known; name an address of this computer";
    default:
      return begin + std::strerror(error);
  }
}

}  // namespace

HttpServer::HttpServer(const HttpLimits& limits) : limits_(limits) {
  // One thread more than connections: it is the one that turns away.
  new_task_queue = [this] {
    return new httplib::ThreadPool(static_cast<std::size_t>(limits_.max_connections) + 1);
  };
  set_payload_max_length(limits.max_request_bytes);
  set_tcp_nodelay(true);
  set_keep_alive_max_count(1'000'000);  // only told to clients: serve() keeps no count
  set_keep_alive_timeout(limits.idle_timeout_ms / 1000);
  // Not the library's SO_REUSEPORT, with which two programs would share a port and each get half of the requests.
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
}

HttpServer::~HttpServer() { stop(); }

int HttpServer::start(const ListenAddress& address) {
  errno = 0;
  int port = address.port;
  if (port == 0) {
    port = bind_to_any_port(address.host);
  } else if (!bind_to_port(address.host, port)) {
    port = -1;
  }
  if (port < 0) throw DataError(cannot_listen(address, errno));
  thread_ = std::thread([this] {
    lower_priority();
    listen_after_bind();
  });
  // Before it runs, the library's stop() does nothing.
  while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return port;
}

void HttpServer::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const socket_t socket : sockets_) shutdown(socket, SHUT_RDWR);
  }
  httplib::Server::stop();
  if (thread_.joinable()) thread_.join();
}

bool HttpServer::process_and_close_socket(socket_t socket) {
  lower_priority();
  bool served = false;
  if (enter(socket)) {
    served = serve(socket);
    part(socket);
    leave(socket);
  } else {
    static_cast<void>(send(socket, kBusy, sizeof kBusy - 1, MSG_NOSIGNAL | MSG_DONTWAIT));
    part(socket);
  }
  close(socket);
  return served;
}

bool HttpServer::enter(socket_t socket) {
  const std::lock_guard lock(mutex_);
  if (stopping_ || sockets_.size() >= static_cast<std::size_t>(limits_.max_connections)) return false;
  sockets_.insert(socket);
  return true;
}

void HttpServer::leave(socket_t socket) {
  const std::lock_guard lock(mutex_);
  sockets_.erase(socket);
}

bool HttpServer::serve(socket_t socket) {
  LimitedStream stream(socket, limits_);
  bool last = false;
  while (!last && stream.next_request()) {
    bool closed = false;
    // After what is no request, or a refused one whose body was left unread, nothing tells where the next begins.
    last = true;
    const Note note = [&last](httplib::Request& request) {
      last = request.method != "GET" && request.method != "HEAD";
      if (last) request.headers.emplace("Connection", "close");
    };
    if (!process(*this, stream, closed, note, &HttpServer::process_request) || closed) return false;
  }
  return true;
}

}  // namespace alight
