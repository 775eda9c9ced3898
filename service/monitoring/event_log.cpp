#include "telltale/service/monitoring/event_log.hpp"

#include <algorithm>

namespace telltale {

void EventLog::Add(const std::string& name, const std::string& data) {
  {
    const std::lock_guard lock(mutex_);
    kept_.push_back(std::make_shared<const std::string>(
        "id: " + std::to_string(end_) + "\nevent: " + name + "\ndata: " + data + "\n\n"));
    ++end_;
    if (kept_.size() > kKept) kept_.pop_front();
  }
  added_.notify_all();
}

std::uint64_t EventLog::End() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

EventLog::Batch EventLog::Await(std::uint64_t next, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  added_.wait_for(lock, timeout, [&] { return closed_ || end_ > next; });
  Batch batch;
  batch.closed = closed_;
  const std::uint64_t oldest = end_ - kept_.size();
  const std::uint64_t from = std::clamp(next, oldest, end_);
  batch.events.assign(kept_.begin() + static_cast<std::ptrdiff_t>(from - oldest), kept_.end());
  batch.next = end_;
  return batch;
}

void EventLog::Close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  added_.notify_all();
}

}  // namespace telltale
