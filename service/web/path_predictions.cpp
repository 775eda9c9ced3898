#include "telltale/service/web/path_predictions.hpp"

#include <algorithm>
#include <utility>

namespace telltale {
namespace {

constexpr std::chrono::seconds kServesFor{5};
constexpr int kRestPerWork = 3;

}  // namespace

PathPredictions::Answer PathPredictions::Ask(
    const Question& question, const std::function<Result<PredictedPaths>()>& predict) {
  Lock lock(mutex_);
  if (Answer known = AwaitAnswerOrTurn(lock, question)) return known;
  if (computing_ || Clock::now() < rests_until_) return nullptr;
  computing_ = true;
  lock.unlock();
  const auto begun = Clock::now();
  Answer answer;
  try {
    answer = std::make_shared<const Result<PredictedPaths>>(predict());
  } catch (...) {
    lock.lock();
    EndTurn(begun);
    throw;
  }
  lock.lock();
  kept_.insert_or_assign(question, Kept{answer, Clock::now() + kServesFor});
  EndTurn(begun);
  return answer;
}

/// Null where there is a turn, or where the patience has ended.
PathPredictions::Answer PathPredictions::AwaitAnswerOrTurn(Lock& lock, const Question& question) {
  const auto deadline = Clock::now() + patience_;
  while (true) {
    const auto now = Clock::now();
    std::erase_if(kept_, [now](const auto& entry) { return entry.second.until <= now; });
    if (const auto known = kept_.find(question); known != kept_.end()) return known->second.answer;
    const bool has_turn = !computing_ && now >= rests_until_;
    if (has_turn || now >= deadline) return nullptr;
    changed_.wait_until(lock, computing_ ? deadline : std::min(deadline, rests_until_));
  }
}

/// The caller holds mutex_.
void PathPredictions::EndTurn(Clock::time_point begun) {
  const auto now = Clock::now();
  rests_until_ = now + kRestPerWork * (now - begun);
  computing_ = false;
  changed_.notify_all();
}

}  // namespace telltale
