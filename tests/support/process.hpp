#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telltale {

/// A program run by a test: its output is gathered, and it does not outlive the test.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// Reads on until standard output and error together contain `text`; false when the program ended
  /// or `timeout` passed without.
  bool WaitForOutput(std::string_view text,
                     std::chrono::seconds timeout = std::chrono::seconds(60));

  /// The exit code, or nothing when it ended otherwise or is still running after `timeout`.
  std::optional<int> Wait(std::chrono::seconds timeout = std::chrono::seconds(180));

  void Signal(int signal) const;

  /// Stops the program where it is; it does nothing more once this returns.
  void Suspend() const;
  void Resume() const;

  /// All it has written to standard output and error so far.
  const std::string& output() const { return output_; }

 private:
  /// Takes in what there is; false once the program has closed its output or the deadline passed.
  bool ReadUntil(std::chrono::steady_clock::time_point deadline);

  pid_t pid_ = -1;
  int pipe_ = -1;
  bool reaped_ = false;
  std::string output_;
};

}  // namespace telltale
