#pragma once

#include <csignal>
#include <optional>

#include <sys/types.h>

namespace alight {

/// What is known of a child process.
struct ChildState {
  bool ended = false;
  /// As waitpid(2) gives it, once the child has ended. Empty where nobody knows it any more: somebody else waited for
  /// the child, or SIGCHLD was ignored when it ended.
  std::optional<int> status;

  /// Whether the child ended by itself with exit code 0, as far as is known.
  bool succeeded() const;
};

/// Looks at a child without waiting for it.
ChildState look_at_child(pid_t child);

/// Waits until a child has ended, however often a signal interrupts that.
ChildState wait_for_child(pid_t child);

/// While it lives, the kernel keeps ended children until they are waited for. Whoever started this program may have left
/// SIGCHLD ignored, and then their exit codes would be lost. It sets the signal's handling for the whole process.
class EndedChildrenAreKept {
 public:
  EndedChildrenAreKept();
  ~EndedChildrenAreKept();
  EndedChildrenAreKept(const EndedChildrenAreKept&) = delete;
  EndedChildrenAreKept& operator=(const EndedChildrenAreKept&) = delete;

 private:
  struct sigaction before_{};
};

}  // namespace alight
