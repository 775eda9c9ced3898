#include "telltale/client/cli/progress_line.hpp"

#include <unistd.h>

#include <iostream>

#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

constexpr std::chrono::seconds kDisplayDelay{2};
constexpr std::chrono::milliseconds kRedraw{200};

}  // namespace

ProgressLine::ProgressLine() {
  if (!isatty(STDERR_FILENO)) return;
  drawer_ = std::jthread([this](const std::stop_token& stop) { Draw(stop); });
}

ProgressLine::~ProgressLine() = default;

void ProgressLine::Update(std::string_view stage, double fraction) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  fraction_ = fraction;
}

void ProgressLine::Draw(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const auto wait = [&](auto time) {
    changed_.wait_until(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
  };
  if (!wait(begun_ + kDisplayDelay)) return;
  do {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun_;
    std::cerr << kClearLine << stage_ << "  " << Fixed(100.0 * fraction_, 0) << " %  "
              << Fixed(elapsed.count(), 0) << " s" << std::flush;
  } while (wait(std::chrono::steady_clock::now() + kRedraw));
  std::cerr << kClearLine << std::flush;
}

}  // namespace telltale
