#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace telltale {

/// Takes what stands on a terminal's line away.
inline constexpr std::string_view kClearLine = "\r\033[K";

/// A line on standard error with the stage, its share and the elapsed time, drawn anew in place.
/// It appears after two seconds, on a terminal only, and the destructor erases it. Thread safe.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void Update(std::string_view stage, double fraction);

 private:
  void Draw(const std::stop_token& stop);

  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::string stage_;
  double fraction_ = 0.0;
  std::jthread drawer_;
};

}  // namespace telltale
