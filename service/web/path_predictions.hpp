#pragma once

#include <chrono>
#include <compare>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/service/models/predicted_paths.hpp"

namespace telltale {

/// Predicted paths for whoever asks, at a bounded cost: one computation at a time, and after it a
/// rest of three times its duration, so that all of them take a quarter of one core at most. An
/// answer serves everybody who asks the same within five seconds. Safe to use from several threads.
class PathPredictions {
 public:
  using Clock = std::chrono::steady_clock;

  struct Question {
    std::string vehicle_id;
    std::uint64_t revision = 0;  ///< of the model
    std::uint64_t span_s = 0;
    std::uint64_t horizon_s = 0;

    auto operator<=>(const Question&) const = default;
  };
  using Answer = std::shared_ptr<const Result<PredictedPaths>>;

  /// Who asks waits for a turn no longer than `patience`.
  explicit PathPredictions(Clock::duration patience = std::chrono::seconds(2))
      : patience_(patience) {}

  /// The answer that is known, or that `predict` gives. Null where no turn comes in time: others
  /// ask too much.
  Answer Ask(const Question& question, const std::function<Result<PredictedPaths>()>& predict);

 private:
  struct Kept {
    Answer answer;
    Clock::time_point until;
  };
  using Lock = std::unique_lock<std::mutex>;

  Answer AwaitAnswerOrTurn(Lock& lock, const Question& question);
  void EndTurn(Clock::time_point begun);

  const Clock::duration patience_;
  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::map<Question, Kept> kept_;
  bool computing_ = false;
  Clock::time_point rests_until_;
};

}  // namespace telltale
