#pragma once

#include <sys/types.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace telltale {

/// A program run by a test: its output is gathered, and it does not outlive the test. A thread
/// reads the output as it comes, since a program stops at its next line where a pipe is full.
class Process {
 public:
  /// kUnread: into a pipe of a page that nobody reads.
  enum class Output { kGathered, kUnread };

  explicit Process(const std::vector<std::string>& command, Output output = Output::kGathered);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// Waits until standard output and error together contain `text`; false when the program ended
  /// or `timeout` passed without.
  bool WaitForOutput(std::string_view text,
                     std::chrono::seconds timeout = std::chrono::seconds(60));

  /// The exit code, or nothing when it ended otherwise or is still running after `timeout`.
  std::optional<int> Wait(std::chrono::seconds timeout = std::chrono::seconds(180));

  void Signal(int signal) const;
  pid_t id() const { return pid_; }

  /// Stops the program where it is; it does nothing more once this returns.
  void Suspend() const;
  void Resume() const;

  /// All it has written to standard output and error so far.
  std::string output() const;

 private:
  void Gather();
  bool TakeIn();  ///< waits for what there is; false at the end

  pid_t pid_ = -1;
  int pipe_ = -1;
  int leave_ = -1;  ///< can be read once nobody wants more output; others may hold the pipe open
  bool reaped_ = false;

  mutable std::mutex mutex_;  // of what follows
  std::condition_variable came_;
  std::string output_;
  bool ended_ = false;  ///< all output is there
  std::thread gathering_;
};

}  // namespace telltale
