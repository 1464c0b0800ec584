#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>
#include <unistd.h>

namespace alight::test {

/// What a command said, and how it ended.
struct CommandRun {
  int exit_code = -1;  ///< 128 and more: the signal that ended it
  std::string out;     ///< stdout and stderr, as far as the command line leaves them
};

/// Runs a command line of the shell to its end, without input. @throws std::runtime_error if there is no shell
CommandRun run_command(const std::string& command_line);

/// Whether Debian's Python can import these, as "rosbag, genpy".
bool python_has(const std::string& modules);

/// The command that has the shell run a line; with `exec` in it, signals meet the program itself.
std::vector<std::string> shell_command(const std::string& line);

/// A program that runs beside the test, in a process group of its own, and is ended with this object. What it says goes
/// to a file.
class Program {
 public:
  /// @param command the program and its arguments @param log where stdout and stderr go
  Program(const std::vector<std::string>& command, std::filesystem::path log);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  /// Asks it to end (SIGINT), and makes it end if it does not.
  ~Program();

  bool running();
  /// To the program and its children.
  void send(int signal) const;
  /// Waits for the end. @returns the exit code, 128 and more: the signal that ended it; -1 if it had to be killed after
  /// `timeout_s`
  int wait(double timeout_s);
  std::string said() const;

 private:
  pid_t pid_ = -1;
  int exit_code_ = -1;
  std::filesystem::path log_;
};

/// A copy of this process that runs a function and ends with the exit code that it returns, or 99 where it throws: for
/// what kills, limits or starves the process that it happens to. @returns the child, to be waited for
template <class Body>
pid_t start_copy(const Body& body) {
  const pid_t child = fork();
  if (child != 0) return child;
  int exit_code = 99;
  try {
    exit_code = body();
  } catch (...) {
  }
  _exit(exit_code);  // what the test registered for its own end is not the child's
}

}  // namespace alight::test
