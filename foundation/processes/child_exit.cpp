#include "foundation/processes/child_exit.hpp"

#include <cerrno>

#include <sys/wait.h>

namespace alight {
namespace {

ChildState wait_with(pid_t child, int options) {
  int status = 0;
  pid_t found = 0;
  do found = waitpid(child, &status, options);
  while (found < 0 && errno == EINTR);
  if (found == 0) return {};
  // Every other error (ECHILD) means that there is no such child any more.
  return {true, found == child ? std::optional(status) : std::nullopt};
}

}  // namespace

bool ChildState::succeeded() const { return status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0; }

ChildState look_at_child(pid_t child) { return wait_with(child, WNOHANG); }

ChildState wait_for_child(pid_t child) { return wait_with(child, 0); }

EndedChildrenAreKept::EndedChildrenAreKept() {
  struct sigaction kept{};
  kept.sa_handler = SIG_DFL;
  sigaction(SIGCHLD, nullptr, &before_);
  const bool loses = before_.sa_handler == SIG_IGN || (before_.sa_flags & SA_NOCLDWAIT) != 0;
  if (loses) sigaction(SIGCHLD, &kept, nullptr);
}

EndedChildrenAreKept::~EndedChildrenAreKept() { sigaction(SIGCHLD, &before_, nullptr); }

}  // namespace alight
