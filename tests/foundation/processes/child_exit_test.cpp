#include "foundation/processes/child_exit.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/programs.hpp"

namespace alight {
namespace {

pid_t child_that_exits(int code) {
  return test::start_copy([&] { return code; });
}

/// Ends when the other end of the pipe is closed.
class WaitingChild {
 public:
  WaitingChild() {
    EXPECT_EQ(pipe(ends_), 0);
    pid_ = test::start_copy([&] {
      close(ends_[1]);
      char byte = 0;
      return read(ends_[0], &byte, 1) == 0 ? 0 : 1;
    });
  }
  pid_t pid() const { return pid_; }
  void let_go() const {
    close(ends_[0]);
    close(ends_[1]);
  }

 private:
  int ends_[2] = {};
  pid_t pid_ = -1;
};

class ChildExit : public ::testing::Test {
 protected:
  ~ChildExit() override { std::signal(SIGCHLD, SIG_DFL); }
};

TEST_F(ChildExit, TheExitCodeSaysWhetherItSucceeded) {
  const ChildState good = wait_for_child(child_that_exits(0));
  EXPECT_TRUE(good.ended);
  EXPECT_TRUE(good.succeeded());
  const ChildState bad = wait_for_child(child_that_exits(3));
  EXPECT_TRUE(bad.ended);
  EXPECT_FALSE(bad.succeeded());
  ASSERT_TRUE(bad.status);
  EXPECT_EQ(WEXITSTATUS(*bad.status), 3);
}

TEST_F(ChildExit, AKilledChildDidNotSucceed) {
  const WaitingChild child;
  kill(child.pid(), SIGKILL);
  const ChildState state = wait_for_child(child.pid());
  EXPECT_TRUE(state.ended);
  EXPECT_FALSE(state.succeeded());
  child.let_go();
}

TEST_F(ChildExit, LookingDoesNotWait) {
  const WaitingChild child;
  EXPECT_FALSE(look_at_child(child.pid()).ended);
  child.let_go();
  EXPECT_TRUE(wait_for_child(child.pid()).succeeded());
}

TEST_F(ChildExit, AChildWhoseEndIsLostHasEndedWithoutAStatus) {
  std::signal(SIGCHLD, SIG_IGN);
  const pid_t child = child_that_exits(0);
  const ChildState state = wait_for_child(child);
  EXPECT_TRUE(state.ended);
  EXPECT_FALSE(state.status);
  EXPECT_FALSE(state.succeeded());
  EXPECT_TRUE(look_at_child(child).ended);
}

TEST_F(ChildExit, IsKeptThoughTheSignalWasIgnored) {
  std::signal(SIGCHLD, SIG_IGN);
  {
    const EndedChildrenAreKept kept;
    EXPECT_TRUE(wait_for_child(child_that_exits(0)).succeeded());
  }
  EXPECT_EQ(std::signal(SIGCHLD, SIG_DFL), SIG_IGN) << "the handling is put back";
}

}  // namespace
}  // namespace alight
