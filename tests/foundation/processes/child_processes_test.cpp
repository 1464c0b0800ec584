#include "foundation/processes/child_processes.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Progress = std::function<void(double)>;

ChildOutcome run_one(const ChildBody& body, const ChildLimits& limits = {}) {
  return run_in_children({body}, 1, limits, {}).at(0);
}

TEST(ChildProcesses, ThatEndWellAreDone) {
  const ChildOutcome outcome = run_one([](const Progress&) {});
  EXPECT_EQ(outcome.kind, ChildOutcome::Kind::kDone);
  EXPECT_EQ(outcome.error, "");
}

TEST(ChildProcesses, ErrorsComeBackWithTheirKindAndEveryLine) {
  const ChildOutcome data = run_one([](const Progress&) { throw DataError("a.bag: is\ndamaged"); });
  EXPECT_EQ(data.kind, ChildOutcome::Kind::kFailed);
  EXPECT_EQ(data.error, "a.bag: is\ndamaged");
  const ChildOutcome config = run_one([](const Progress&) { throw ConfigError("crop_px"); });
  EXPECT_EQ(config.kind, ChildOutcome::Kind::kBadConfig);
  EXPECT_EQ(config.error, "crop_px");
}

TEST(ChildProcesses, ACrashIsAnErrorOfThatChildAlone) {
  const std::vector<ChildOutcome> outcomes =
      run_in_children({[](const Progress&) {},
                       [](const Progress&) {
                         std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would report it and exit
                         std::raise(SIGSEGV);
                       },
                       [](const Progress&) {}},
                      2, {}, {});
  EXPECT_EQ(outcomes[0].kind, ChildOutcome::Kind::kDone);
  EXPECT_EQ(outcomes[1].kind, ChildOutcome::Kind::kFailed);
  EXPECT_THAT(outcomes[1].error, AllOf(HasSubstr("crashed"), HasSubstr("Segmentation fault")));
  EXPECT_EQ(outcomes[2].kind, ChildOutcome::Kind::kDone);
}

TEST(ChildProcesses, AnExitWithoutAResultIsAnError) {
  EXPECT_THAT(run_one([](const Progress&) { _exit(0); }).error, HasSubstr("without a result (exit code 0)"));
  EXPECT_THAT(run_one([](const Progress&) { _exit(3); }).error, HasSubstr("without a result (exit code 3)"));
}

TEST(ChildProcesses, AHangIsStopped) {
  ChildLimits limits;
  limits.max_silence_s = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  const ChildOutcome outcome = run_one(
      [](const Progress& progress) {
        progress(0.5);
        std::this_thread::sleep_for(std::chrono::minutes(5));
      },
      limits);
  EXPECT_EQ(outcome.kind, ChildOutcome::Kind::kFailed);
  EXPECT_THAT(outcome.error, AllOf(HasSubstr("no progress"), HasSubstr("max_silence_s")));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes(1));
}

/// By a clock that goes on by 0.6 s whenever the child says something.
TEST(ChildProcesses, SlowProgressIsNoHang) {
  ChildLimits limits;
  limits.max_silence_s = 1;
  std::chrono::steady_clock::time_point now;
  double heard = 0;
  const ChildBody body = [](const Progress& progress) {
    for (int i = 1; i <= 15; ++i) {
      progress(i / 15.0);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // one by one, mostly
    }
  };
  const auto tick = [&](std::size_t, double share) {
    if (share > heard) now += std::chrono::milliseconds(600);
    heard = share;
  };
  const ChildOutcome outcome = run_in_children({body}, 1, limits, tick, [&] { return now; }).at(0);
  EXPECT_EQ(outcome.kind, ChildOutcome::Kind::kDone) << outcome.error;
}

TEST(ChildProcesses, TooMuchMemoryIsStopped) {
  ChildLimits limits;
  limits.max_memory_mib = 600;
  std::vector<char> hoard;
  const ChildOutcome outcome = run_one(
      [&](const Progress& progress) {
        hoard.assign(700 << 20, 'x');
        progress(0.5);
        std::this_thread::sleep_for(std::chrono::minutes(1));
      },
      limits);
  EXPECT_THAT(outcome.error, AllOf(HasSubstr("600 MiB"), HasSubstr("max_memory_mib")));
}

TEST(ChildProcesses, NoMoreRunAtATimeThanAsked) {
  test::ScratchFolder folder;
  const ChildBody body = [&](const Progress&) {
    const auto mine = folder.path() / std::to_string(getpid());
    std::ofstream(mine).put('x');
    const auto running = std::distance(std::filesystem::directory_iterator(folder.path()), {});
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    std::filesystem::remove(mine);
    if (running > 2) throw DataError(std::to_string(running) + " at a time");
  };
  for (const ChildOutcome& outcome : run_in_children(std::vector<ChildBody>(8, body), 2, {}, {}))
    EXPECT_EQ(outcome.kind, ChildOutcome::Kind::kDone) << outcome.error;
}

TEST(ChildProcesses, ProgressArrivesForEachAndEndsAtAll) {
  std::vector<double> shares(2, 0);
  const ChildBody body = [](const Progress& progress) {
    for (int i = 0; i <= 10; ++i) progress(i / 10.0);
  };
  run_in_children({body, body}, 2, {}, [&](std::size_t index, double share) {
    EXPECT_GE(share, shares.at(index));
    shares[index] = share;
  });
  EXPECT_EQ(shares, (std::vector<double>{1, 1}));
}

TEST(ChildProcesses, WhatTheProgressThrowsEndsAllChildren) {
  const ChildBody body = [](const Progress& progress) {
    progress(0.1);
    std::this_thread::sleep_for(std::chrono::minutes(1));
  };
  EXPECT_THROW(run_in_children({body, body}, 2, {},
                               [](std::size_t, double share) {
                                 if (share > 0) throw std::runtime_error("stop");
                               }),
               std::runtime_error);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST(ChildProcesses, ACrashIsToldThoughWhoeverStartedUsIgnoresTheEndsOfChildren) {
  std::signal(SIGCHLD, SIG_IGN);
  const ChildOutcome outcome = run_one([](const Progress&) { std::raise(SIGKILL); });
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_THAT(outcome.error, HasSubstr("crashed its reader (Killed)"));
}

TEST(ChildProcesses, AnEndThatSomebodyElseTookIsNoHang) {
  const ChildBody body = [](const Progress& progress) {
    progress(0.5);
    _exit(0);
  };
  const auto take = [](std::size_t, double share) {
    if (share > 0 && share < 1) waitpid(-1, nullptr, 0);
  };
  EXPECT_THAT(run_in_children({body}, 1, {}, take).at(0).error, HasSubstr("exit code is lost"));
}

/// Four programs, each of which leaves a mark; the third fails.
class ChildPrograms : public ::testing::Test {
 protected:
  ~ChildPrograms() override { std::signal(SIGCHLD, SIG_DFL); }

  /// @returns how many failed
  int run(int jobs = 2, const std::function<void()>& before_each = [] {}) {
    return run_programs(
        4, jobs,
        [&](std::size_t index) {
          before_each();
          const std::string mark = (folder_ / std::to_string(index)).string();
          return std::vector<std::string>{"/bin/sh", "-c",
                                          "echo x >> " + mark + "; exit " + (index == 2 ? "1" : "0")};
        },
        [&] { ++finished_; });
  }
  void expect_each_ran_once() const {
    EXPECT_EQ(finished_, 4);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(std::filesystem::file_size(folder_ / std::to_string(i)), 2u) << i;
  }

  const test::ScratchFolder folder_;
  int finished_ = 0;
};

TEST_F(ChildPrograms, RunOnceEachAndFailuresAreCounted) {
  EXPECT_EQ(run(), 1);
  expect_each_ran_once();
}

TEST_F(ChildPrograms, AreCountedThoughWhoeverStartedUsIgnoresTheEndsOfChildren) {
  std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run(), 1);
  expect_each_ran_once();
}

TEST_F(ChildPrograms, WhoseEndSomebodyElseTookCountAsFailed) {
  int taken = 0;
  const int failed = run(4, [&] {
    while (waitpid(-1, nullptr, 0) > 0) ++taken;
  });
  EXPECT_EQ(taken, 3) << "all but the last";
  EXPECT_EQ(failed, 3);
  expect_each_ran_once();
}

TEST_F(ChildPrograms, ThatCannotBeStartedCountAsFailed) {
  const auto command = [](std::size_t) { return std::vector<std::string>{"/no/such/program"}; };
  EXPECT_EQ(run_programs(2, 1, command, [&] { ++finished_; }), 2);
  EXPECT_EQ(finished_, 0);
}

}  // namespace
}  // namespace alight
