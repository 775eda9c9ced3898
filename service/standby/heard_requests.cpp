#include "telltale/service/standby/heard_requests.hpp"

#include <optional>
#include <utility>
#include <variant>

namespace telltale {
namespace {

/// The request with what is left of its deadline after `waited_s`; nothing where it has passed.
std::optional<AnyRequest> LeftAfter(AnyRequest request, double waited_s) {
  const bool in_time = std::visit(
      [waited_s](auto& kind) {
        if (kind.deadline_s <= 0.0) return true;  // it has none
        kind.deadline_s -= waited_s;
        return kind.deadline_s > 0.0;
      },
      request);
  return in_time ? std::optional(std::move(request)) : std::nullopt;
}

}  // namespace

bool HeardRequests::Note(const AnyRequest& request, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (taken_) return false;
  const std::string& id = CorrelationIdOf(request);
  if (answered_.contains(id)) return true;
  const auto [heard, is_new] = unanswered_.try_emplace(id);
  heard->second.request = request;
  heard->second.since = now;
  if (is_new) order_.push_back(id);
  if (order_.size() > kMost) {
    unanswered_.erase(order_.front());
    order_.pop_front();
  }
  return true;
}

void HeardRequests::Answered(const std::string& correlation_id) {
  const std::lock_guard lock(mutex_);
  unanswered_.erase(correlation_id);
  if (!answered_.insert(correlation_id).second) return;
  answered_order_.push_back(correlation_id);
  if (answered_order_.size() > kMost) {
    answered_.erase(answered_order_.front());
    answered_order_.pop_front();
  }
}

void HeardRequests::Begun(const std::string& correlation_id) {
  const std::lock_guard lock(mutex_);
  const auto heard = unanswered_.find(correlation_id);
  if (heard != unanswered_.end()) heard->second.begun = true;
}

std::vector<HeardRequest> HeardRequests::TakeUnanswered(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  taken_ = true;
  std::vector<HeardRequest> requests;
  for (const std::string& id : std::exchange(order_, {})) {
    const auto heard = unanswered_.find(id);
    if (heard == unanswered_.end()) continue;
    const std::chrono::duration<double> waited = now - heard->second.since;
    if (auto left = LeftAfter(std::move(heard->second.request), waited.count())) {
      requests.push_back({*std::move(left), heard->second.begun});
    }
    unanswered_.erase(heard);
  }
  return requests;
}

}  // namespace telltale
