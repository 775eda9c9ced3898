#include "telltale/service/slices/slice_keeper.hpp"

#include <iterator>
#include <set>
#include <utility>

#include <spdlog/spdlog.h>

namespace telltale {
namespace {

/// Its first `count` slices.
Slices Lowest(const Slices& slices, int count) {
  const auto end =
      count < static_cast<int>(slices.size()) ? std::next(slices.begin(), count) : slices.end();
  return {slices.begin(), end};
}

}  // namespace

SliceKeeper::SliceKeeper(SliceLeases& leases, HeldSlices& held, FleetShare wanted,
                         std::function<void()> changed)
    : leases_(leases),
      held_(held),
      wanted_(wanted),
      changed_(std::move(changed)),
      run_out_(Clock::now()),
      to_apply_(held.Get()),
      applied_(to_apply_) {
  keeping_ = std::thread([this] { Keep(); });
  applying_ = std::thread([this] { Apply(); });
}

SliceKeeper::~SliceKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  keeping_.join();
  applying_.join();
}

void SliceKeeper::Keep() {
  const std::chrono::duration<double> period(leases_.lease_s() / 4.0);
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    Turn();
    lock.lock();
    wake_.wait_for(lock, period, [this] { return stopping_; });
  }
}

void SliceKeeper::Turn() {
  const auto asked = Clock::now();
  try {
    Hold(Share());
    run_out_ = asked + std::chrono::duration_cast<Clock::duration>(
                           std::chrono::duration<double>(leases_.lease_s()));
    if (!reached_last_time_) spdlog::info("the leases of this daemon's slices are renewed again");
    reached_last_time_ = true;
  } catch (const DatabaseError& error) {
    if (reached_last_time_) spdlog::error("{}; no lease is renewed", error.what());
    reached_last_time_ = false;
    if (wanted_ == FleetShare::kPart && Clock::now() >= run_out_) Hold({});
  }
}

/// What this daemon is to serve from now on.
Slices SliceKeeper::Share() {
  const Slices renewed = leases_.Renew();
  const int due = Due();
  Slices share = Lowest(renewed, due);
  ReleaseWhatIsNotServed(renewed);
  if (static_cast<int>(renewed.size()) < due) {
    share.merge(leases_.Claim(due - static_cast<int>(renewed.size())));
  }
  return share;
}

/// How many slices.
int SliceKeeper::Due() {
  if (wanted_ == FleetShare::kAll) return kFleetSlices;
  const int daemons = leases_.LiveDaemons();
  return (kFleetSlices + daemons - 1) / daemons;
}

/// Leases of slices that are neither to be served nor served any more.
void SliceKeeper::ReleaseWhatIsNotServed(const Slices& renewed) {
  std::set<int> idle;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [slice, fence] : renewed) {
      if (!to_apply_.contains(slice) && !applied_.contains(slice)) idle.insert(slice);
    }
  }
  if (!idle.empty()) leases_.Release(idle);
}

void SliceKeeper::Hold(const Slices& slices) {
  {
    const std::lock_guard lock(mutex_);
    if (slices == to_apply_) return;
    to_apply_ = slices;
  }
  held_.Set(slices);
  wake_.notify_all();
}

void SliceKeeper::Apply() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stopping_ || applied_ != to_apply_; });
    if (stopping_) return;
    const Slices slices = to_apply_;
    lock.unlock();
    changed_();
    lock.lock();
    applied_ = slices;
  }
}

}  // namespace telltale
