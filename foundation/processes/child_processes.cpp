#include "foundation/processes/child_processes.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <list>
#include <optional>
#include <sstream>
#include <thread>

#include <poll.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/processes/child_exit.hpp"

extern char** environ;

namespace alight {
namespace {

using Time = std::chrono::steady_clock::time_point;

constexpr int kPollMs = 50;
constexpr std::chrono::milliseconds kLookAgain{20};  // at programs, which take seconds

/// What a child says through its pipe: one line each, a letter and its text.
constexpr char kProgressLine = 'p';
constexpr char kConfigLine = 'c';
constexpr char kErrorLine = 'e';
constexpr char kDoneLine = 'd';

/// A pipe's lines carry no line breaks of their own.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n') c = '\v';
  }
  return text;
}
std::string lines_again(std::string text) {
  for (char& c : text) {
    if (c == '\v') c = '\n';
  }
  return text;
}

void write_line(int fd, char kind, const std::string& text) {
  const std::string line = kind + one_line(text) + '\n';
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t written = write(fd, line.data() + at, line.size() - at);
    if (written <= 0) _exit(1);  // the parent is gone
    at += static_cast<std::size_t>(written);
  }
}

[[noreturn]] void run_child(const ChildBody& body, int fd) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  int reported_permille = -1;
  try {
    body([&](double share) {
      const int permille = static_cast<int>(share * 1000);
      if (permille == reported_permille) return;
      reported_permille = permille;
      write_line(fd, kProgressLine, std::to_string(share));
    });
    write_line(fd, kDoneLine, "");
  } catch (const ConfigError& e) {
    write_line(fd, kConfigLine, e.what());
  } catch (const std::exception& e) {
    write_line(fd, kErrorLine, e.what());
  }
  std::fflush(nullptr);
  _exit(0);  // what the parent registered for its own end is not the child's
}

double resident_mib(pid_t pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  long total_pages = 0;
  long resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// One child at work; killed if it is let go before its end.
class Child {
 public:
  Child(std::size_t index, const ChildBody& body, Time now) : index_(index), last_sign_(now) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
    std::fflush(nullptr);  // or the child would write it a second time
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
    if (pid_ == 0) {
      close(ends[0]);
      run_child(body, ends[1]);
    }
    close(ends[1]);
    fd_ = ends[0];
  }
  ~Child() {
    if (fd_ >= 0) close(fd_);
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    wait_for_child(pid_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  std::size_t index() const { return index_; }
  int fd() const { return fd_; }
  bool ended() const { return fd_ < 0; }
  double share() const { return share_; }
  const ChildOutcome& outcome() const { return outcome_; }

  /// Takes what the pipe holds; at its end, the child's.
  void read_pipe(Time now) {
    char buffer[4096];
    const ssize_t count = read(fd_, buffer, sizeof buffer);
    if (count <= 0) return finish();
    last_sign_ = now;
    text_.append(buffer, static_cast<std::size_t>(count));
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      take_line(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
  }

  void enforce(const ChildLimits& limits, Time now) {
    const double silence_s = std::chrono::duration<double>(now - last_sign_).count();
    std::ostringstream reason;
    if (silence_s > limits.max_silence_s) {
      reason << "made no progress for " << limits.max_silence_s
             << " s and was stopped (limits.max_silence_s)";
    } else if (resident_mib(pid_) > limits.max_memory_mib) {
      reason << "needed more than " << limits.max_memory_mib
             << " MiB and was stopped (limits.max_memory_mib)";
    } else {
      return;
    }
    kill(pid_, SIGKILL);
    finish();
    outcome_ = {ChildOutcome::Kind::kFailed, reason.str()};
  }

 private:
  void take_line(const std::string& line) {
    const std::string text = lines_again(line.substr(1));
    switch (line[0]) {
      case kProgressLine:
        share_ = std::stod(text);
        break;
      case kConfigLine:
        outcome_ = {ChildOutcome::Kind::kBadConfig, text};
        break;
      case kDoneLine:
        outcome_ = {ChildOutcome::Kind::kDone, {}};
        break;
      default:
        outcome_ = {ChildOutcome::Kind::kFailed, text};
    }
  }

  void finish() {
    close(fd_);
    fd_ = -1;
    const std::optional<int> status = wait_for_child(pid_).status;
    pid_ = -1;
    const bool no_result = outcome_.kind == ChildOutcome::Kind::kFailed && outcome_.error.empty();
    if (!status) {
      if (no_result) outcome_.error = "ended its reader without a result (its exit code is lost)";
    } else if (WIFSIGNALED(*status)) {
      outcome_ = {ChildOutcome::Kind::kFailed,
                  std::string("crashed its reader (") + strsignal(WTERMSIG(*status)) + ")"};
    } else if (WEXITSTATUS(*status) != 0 || no_result) {
      outcome_ = {ChildOutcome::Kind::kFailed, "ended its reader without a result (exit code " +
                                                   std::to_string(WEXITSTATUS(*status)) + ")"};
    }
  }

  std::size_t index_;
  pid_t pid_ = -1;
  int fd_ = -1;
  Time last_sign_;
  std::string text_;
  double share_ = 0;
  ChildOutcome outcome_;
};

void wait_for_news(std::list<Child>& children, const std::function<Time()>& now) {
  std::vector<pollfd> pipes;
  for (const Child& child : children) pipes.push_back({child.fd(), POLLIN, 0});
  poll(pipes.data(), pipes.size(), kPollMs);
  auto pipe = pipes.begin();
  for (Child& child : children) {
    if ((pipe++)->revents != 0) child.read_pipe(now());
  }
}

}  // namespace

void bind(Binder& b, ChildLimits& c) {
  b.field("max_silence_s", c.max_silence_s, "a log whose reader makes no progress for longer is given up",
          positive());
  b.field("max_memory_mib", c.max_memory_mib, "a log whose reader needs more memory is given up", positive());
}

std::vector<ChildOutcome> run_in_children(const std::vector<ChildBody>& bodies, int at_once,
                                          const ChildLimits& limits,
                                          const std::function<void(std::size_t, double)>& progress,
                                          const std::function<Time()>& now) {
  const EndedChildrenAreKept kept;
  std::vector<ChildOutcome> outcomes(bodies.size());
  std::list<Child> children;
  std::size_t next = 0;
  while (next < bodies.size() || !children.empty()) {
    while (next < bodies.size() && children.size() < static_cast<std::size_t>(at_once)) {
      children.emplace_back(next, bodies[next], now());
      ++next;
    }
    wait_for_news(children, now);
    for (auto child = children.begin(); child != children.end();) {
      if (!child->ended()) child->enforce(limits, now());
      if (progress) progress(child->index(), child->ended() ? 1 : child->share());
      if (child->ended()) outcomes[child->index()] = child->outcome();
      child = child->ended() ? children.erase(child) : std::next(child);
    }
  }
  return outcomes;
}

int run_programs(std::size_t count, int at_once,
                 const std::function<std::vector<std::string>(std::size_t)>& command,
                 const std::function<void()>& finished) {
  const EndedChildrenAreKept kept;
  int failed = 0;
  std::vector<pid_t> running;
  const auto wait_for_fewer_than = [&](std::size_t fewer) {
    while (running.size() >= fewer) {
      const auto ended = std::remove_if(running.begin(), running.end(), [&](pid_t child) {
        const ChildState state = look_at_child(child);
        if (!state.ended) return false;
        failed += state.succeeded() ? 0 : 1;
        finished();
        return true;
      });
      if (ended == running.end()) std::this_thread::sleep_for(kLookAgain);
      running.erase(ended, running.end());
    }
  };
  for (std::size_t i = 0; i < count; ++i) {
    wait_for_fewer_than(static_cast<std::size_t>(at_once));
    const std::vector<std::string> words = command(i);
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    pid_t child = 0;
    if (const int error = posix_spawn(&child, argv.front(), nullptr, nullptr, argv.data(), environ);
        error != 0) {
      spdlog::error("{}: cannot be started: {}", words.front(), std::strerror(error));
      ++failed;
      continue;
    }
    running.push_back(child);
  }
  wait_for_fewer_than(1);
  return failed;
}

}  // namespace alight
