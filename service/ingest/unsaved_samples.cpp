#include "telltale/service/ingest/unsaved_samples.hpp"

#include <utility>
#include <vector>

namespace telltale {
namespace {

std::size_t BytesOf(const Recording& samples) {
  return samples.gnss.size() * sizeof(GnssFix) + samples.heading.size() * sizeof(HeadingSample) +
         samples.thrusters.size() * sizeof(ThrusterSample);
}

/// Returns how many went.
template <class One>
std::size_t DropOldestEighth(std::vector<One>& samples) {
  const std::size_t oldest = (samples.size() + 7) / 8;
  samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(oldest));
  return oldest;
}

}  // namespace

void UnsavedSamples::LimitMemory(std::size_t memory_bytes) {
  memory_bytes_ = memory_bytes;
  DropBeyondLimit();
}

void UnsavedSamples::Add(const GnssFix& fix) {
  samples_.gnss.push_back(fix);
  DropBeyondLimit();
}

void UnsavedSamples::Add(const HeadingSample& heading) {
  samples_.heading.push_back(heading);
  DropBeyondLimit();
}

void UnsavedSamples::Add(const ThrusterSample& thrusters) {
  samples_.thrusters.push_back(thrusters);
  DropBeyondLimit();
}

Recording UnsavedSamples::Take() {
  return std::exchange(samples_, {});
}

std::size_t UnsavedSamples::size() const {
  return samples_.gnss.size() + samples_.heading.size() + samples_.thrusters.size();
}

void UnsavedSamples::DropBeyondLimit() {
  while (BytesOf(samples_) > memory_bytes_) {
    dropped_ += DropOldestEighth(samples_.gnss) + DropOldestEighth(samples_.heading) +
                DropOldestEighth(samples_.thrusters);
  }
}

}  // namespace telltale
