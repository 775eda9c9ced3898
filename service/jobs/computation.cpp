#include "telltale/service/jobs/computation.hpp"

namespace telltale {

void ProgressMailbox::Post(std::string_view stage, double fraction) {
  {
    const std::lock_guard lock(mutex_);
    if (abandoned_) std::rethrow_exception(abandoned_);
    const bool same_stage = !reports_.empty() && reports_.back().stage == stage;
    if (!same_stage) reports_.push_back({std::string(stage), 0.0});
    reports_.back().fraction = fraction;
  }
  changed_.notify_all();
}

auto ProgressMailbox::Await() -> std::optional<Report> {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return closed_ || !reports_.empty(); });
  if (reports_.empty()) return std::nullopt;
  const Report next = std::move(reports_.front());
  reports_.pop_front();
  return next;
}

void ProgressMailbox::Abandon(std::exception_ptr reason) {
  const std::lock_guard lock(mutex_);
  abandoned_ = std::move(reason);
}

void ProgressMailbox::Close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

void Computation::PassOn(ProgressMailbox& mailbox) const {
  while (const auto report = mailbox.Await()) {
    try {
      report_(report->stage, report->fraction);
    } catch (...) {
      mailbox.Abandon(std::current_exception());
    }
  }
}

}  // namespace telltale
