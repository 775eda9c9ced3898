#include "telltale/service/retention/retention.hpp"

#include <exception>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/unix_now.hpp"

namespace telltale {
namespace {

constexpr double kMiB = 1 << 20;

/// "3 model by count, 2 window_chunk by age"
std::string InWords(const RemovalCounts& removed) {
  std::string words;
  for (const auto& [what, rows] : removed) {
    words += fmt::format("{}{} {} by {}", words.empty() ? "" : ", ", rows, Name(what.first),
                         Name(what.second));
  }
  return words;
}

}  // namespace

Retention::Retention(StoreRetention store)
    : store_(std::move(store)), period_(store_.settings().period_s) {
  activity_.limit_bytes = store_.settings().store_bytes;
  thread_ = std::thread([this] { Run(); });
}

Retention::~Retention() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

RetentionActivity Retention::Activity() const {
  const std::lock_guard lock(mutex_);
  return activity_;
}

void Retention::Run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    Pass();
    lock.lock();
    wake_.wait_for(lock, period_, [this] { return stopping_; });
  }
}

void Retention::Pass() {
  try {
    RetentionPass pass = store_.Apply(UnixNow());
    Log(pass);
    const std::lock_guard lock(mutex_);
    for (const auto& [what, rows] : pass.removed) activity_.removed[what] += rows;
    activity_.last = std::move(pass);
    passed_last_time_ = true;
  } catch (const LeaseLost&) {  // another daemon has the boats now, and removes of them
  } catch (const std::exception& error) {
    if (std::exchange(passed_last_time_, false)) {
      spdlog::error("{}; nothing old is removed from the store", error.what());
    }
  }
}

/// The caller does not hold mutex_; activity_ is changed by this thread alone.
void Retention::Log(const RetentionPass& pass) {
  if (!passed_last_time_) spdlog::info("what is old is removed from the store again");
  const double used_mib = static_cast<double>(pass.UsedBytes()) / kMiB;
  if (!pass.removed.empty()) {
    spdlog::info("removed from the store: {}; it takes {:.1f} MiB", InWords(pass.removed),
                 used_mib);
  }
  if (pass.over_limit == activity_.last.over_limit) return;
  const double limit_mib = static_cast<double>(activity_.limit_bytes) / kMiB;
  if (pass.over_limit) {
    spdlog::error(
        "the store takes {:.1f} MiB of retention.store_mib = {:.0f}, and all that is left is in "
        "use: raise it, or serve fewer boats",
        used_mib, limit_mib);
  } else {
    spdlog::info("the store takes {:.1f} MiB of {:.0f} again", used_mib, limit_mib);
  }
}

}  // namespace telltale
