#include "infer/web/ground_station.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "foundation/config_reader.hpp"
#include "infer/web/access.hpp"
#include "infer/web/flight_view.hpp"
#include "infer/web/http_server.hpp"
#include "infer/web/state_json.hpp"

namespace alight {

extern const std::string_view kPage;  // page.html

namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t kMinTokenLength = 12;
constexpr std::chrono::milliseconds kLongPoll{1000};
constexpr std::chrono::milliseconds kStatisticsPeriod{100};
constexpr char kBearer[] = "Bearer ";

void refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(
      nlohmann::json{{"error", why}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      "application/json");
}

/// A whole number from 0 in a query. @returns empty where it is absent or something else
std::optional<std::int64_t> number_in(const Request& request, const char* key) {
  const std::string text = request.get_param_value(key);
  const bool digits = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (text.empty() || text.size() > 18 || !digits) return std::nullopt;
  return std::stoll(text);
}

std::optional<FlightMode> mode_in(const std::string& body) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object() || !json.contains("mode") || !json["mode"].is_string()) return std::nullopt;
  for (const FlightMode mode : {FlightMode::kAutomatic, FlightMode::kManual}) {
    if (json["mode"] == name(mode)) return mode;
  }
  return std::nullopt;
}

/// The page with a number in it that its own script and style carry, so that no other would run.
void serve_page(Response& response) {
  constexpr std::string_view kPlaceholder = "@NONCE@";
  const std::string nonce = random_token();
  std::string page(kPage);
  for (std::size_t at = page.find(kPlaceholder); at != std::string::npos; at = page.find(kPlaceholder, at))
    page.replace(at, kPlaceholder.size(), nonce);
  response.headers.erase("Content-Security-Policy");
  response.set_header("Content-Security-Policy",
                      "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
                          "'; img-src data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                          "frame-ancestors 'none'");
  response.set_content(page, "text/html; charset=utf-8");
}

HttpLimits limits_of(const GroundStationConfig& config) {
  HttpLimits limits;
  limits.max_connections = config.max_connections;
  return limits;
}

ListenAddress checked_address(const GroundStationConfig& config) {
  const ListenAddress address = parse_listen_address(config.address);
  if (config.token && config.token->size() < kMinTokenLength) {
    throw ConfigError("web token: has " + std::to_string(config.token->size()) + " characters; at least " +
                      std::to_string(kMinTokenLength) + " are needed");
  }
  if (!config.token && !address.loopback()) {
    throw ConfigError(
        "web address " + config.address +
        ": other computers can reach it, so a token is needed; set one, or listen on this computer "
        "alone (:" +
        std::to_string(address.port) + ")");
  }
  return address;
}

}  // namespace

void bind(Binder& b, GroundStationConfig& c) {
  b.field("address", c.address, "host:port; without a host this computer alone, with port 0 a free one");
  b.field("token", c.token, "who has it may switch the mode; required to serve other computers");
  b.field("max_rate_hz", c.max_rate_hz, "frames shown in a second, however many watch", between(0.1, 100));
  b.field("max_connections", c.max_connections, "a viewer has one or two; more are turned away",
          between(1, 256));
  b.field("jpeg_quality", c.jpeg_quality, "of the pictures", between(1, 100));
}

/// What is behind the address: the answers to requests.
class GroundStation::Site {
 public:
  Site(const GroundStationConfig& config, ModeSwitch& mode, const cv::Rect& crop, int confirm_frames)
      : address_(checked_address(config)),
        token_(config.token ? *config.token : random_token()),
        max_rate_hz_(config.max_rate_hz),
        mode_(mode),
        view_({crop, confirm_frames, config.jpeg_quality}, config.max_rate_hz),
        server_(limits_of(config)) {
    route();
    address_.port = server_.start(address_);
    url_ = "http://" + address_.text() + "/";
    // Whoever started the program gets the way in; a token of their own they know, and logs are kept.
    spdlog::info("ground station: {}{}", url_, config.token ? "" : "#token=" + token_);
  }
  ~Site() {
    view_.close();
    server_.stop();
  }
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  FlightView& view() { return view_; }
  const std::string& url() const { return url_; }
  const std::string& token() const { return token_; }

  void set_statistics(std::function<RunnerStatistics()> statistics) {
    const std::lock_guard lock(statistics_mutex_);
    ask_statistics_ = std::move(statistics);
  }

 private:
  void route() {
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"X-Frame-Options", "DENY"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'"}});
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
      return may_enter(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                          : httplib::Server::HandlerResponse::Handled;
    });
    server_.set_error_handler([](const Request&, Response& response) {
      if (response.body.empty()) refuse(response, response.status, "no such page or not a proper request");
    });
    server_.Get("/", [](const Request&, Response& response) { serve_page(response); });
    server_.Get("/state",
                [this](const Request& request, Response& response) { serve_state(request, response); });
    server_.Get("/image/([a-z]+).jpg",
                [this](const Request& request, Response& response) { serve_image(request, response); });
    server_.Post("/mode",
                 [this](const Request& request, Response& response) { switch_mode(request, response); });
  }

  /// What every request has to fulfil before it is looked at.
  bool may_enter(const Request& request, Response& response) const {
    const std::string host = request.get_header_value("Host");
    if (!names_this_server(host, address_)) {
      refuse(response, host.empty() ? 400 : 421, "the Host header does not name this server");
      return false;
    }
    if (!comes_from_own_page(request.get_header_value("Origin"), host)) {
      refuse(response, 403, "the request comes from another page (Origin)");
      return false;
    }
    // The page itself holds nothing; with it, one can type the token.
    const bool open = (address_.loopback() && request.method != "POST") || request.path == "/";
    if (open || has_token(request)) return true;
    response.set_header("WWW-Authenticate", "Bearer");
    refuse(response, 401, "the token is missing or wrong (header \"Authorization: Bearer <token>\")");
    return false;
  }

  bool has_token(const Request& request) const {
    const std::string header = request.get_header_value("Authorization");
    return header.rfind(kBearer, 0) == 0 && equal_in_constant_time(header.substr(sizeof kBearer - 1), token_);
  }

  void serve_state(const Request& request, Response& response) {
    const bool named = request.has_param("after");
    const auto after = named ? number_in(request, "after") : 0;
    if (!after) return refuse(response, 400, "after: expected the number of a frame");
    LiveState state;
    state.frame = named ? view_.wait(*after, kLongPoll) : view_.wait(0, std::chrono::milliseconds(0));
    state.run = run_;
    state.mode = mode_.get();
    state.max_rate_hz = max_rate_hz_;
    state.sensors = view_.sensors();
    state.statistics = statistics();
    if (state.frame) state.history = view_.history(*after, state.frame->number());
    response.set_content(state_json(state), "application/json");
  }

  void serve_image(const Request& request, Response& response) {
    const auto picture = picture_named(request.matches[1]);
    const auto number = number_in(request, "frame");
    if (!picture) return refuse(response, 404, "pictures are left, depth and safe");
    if (!number) return refuse(response, 400, "frame: expected the number of a frame");
    const auto frame = view_.find(*number);
    if (!frame) return refuse(response, 404, "that frame is not shown any more, or not yet");
    response.set_content(frame->jpeg(*picture), "image/jpeg");
  }

  void switch_mode(const Request& request, Response& response) {
    const auto wanted = mode_in(request.body);
    if (!wanted) return refuse(response, 400, R"(expected {"mode": "automatic"} or {"mode": "manual"})");
    const FlightMode before = mode_.get();
    mode_.set(*wanted);
    spdlog::warn("ground station: mode {} -> {}, by {}", name(before), name(*wanted), request.remote_addr);
    response.set_content(nlohmann::json{{"mode", name(mode_.get())}}.dump(), "application/json");
  }

  /// Asked seldom, since the runner's locks are the engine's too.
  RunnerStatistics statistics() {
    const std::lock_guard lock(statistics_mutex_);
    const SteadyTime now = steady_now();
    if (ask_statistics_ && now >= next_statistics_) {
      statistics_ = ask_statistics_();
      next_statistics_ = now + kStatisticsPeriod;
    }
    return statistics_;
  }

  ListenAddress address_;
  std::string token_;
  double max_rate_hz_;
  ModeSwitch& mode_;
  std::string run_ = random_token();
  std::string url_;
  std::mutex statistics_mutex_;
  std::function<RunnerStatistics()> ask_statistics_;
  RunnerStatistics statistics_;
  SteadyTime next_statistics_;
  FlightView view_;
  HttpServer server_;
};

GroundStation::GroundStation(const GroundStationConfig& config, ModeSwitch& mode, const cv::Rect& crop,
                             int confirm_frames)
    : site_(std::make_unique<Site>(config, mode, crop, confirm_frames)) {}
GroundStation::~GroundStation() = default;

void GroundStation::on_message(const LogMessage& message) { site_->view().add(message); }
void GroundStation::on_frame(const FrameReport& frame) { site_->view().add(frame); }
void GroundStation::set_statistics(std::function<RunnerStatistics()> statistics) {
  site_->set_statistics(std::move(statistics));
}
const std::string& GroundStation::url() const { return site_->url(); }
const std::string& GroundStation::token() const { return site_->token(); }

}  // namespace alight
