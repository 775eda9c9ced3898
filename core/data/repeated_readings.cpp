#include "telltale/core/data/repeated_readings.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace telltale {
namespace {

constexpr std::size_t kFewestRuns = 20;
constexpr double kLeastShareRepeated = 0.1;
constexpr double kLeastShareEven = 0.95;

template <class Sample>
std::size_t RepeatsIn(const std::vector<Sample>& samples) {
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (SameReading(samples[i - 1], samples[i])) ++repeats;
  }
  return repeats;
}

/// The lengths of the runs of equal readings, but for the last run, which the recording cuts off.
template <class Sample>
std::vector<std::size_t> RunsOf(const std::vector<Sample>& samples) {
  std::vector<std::size_t> lengths;
  std::size_t start = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (SameReading(samples[i - 1], samples[i])) continue;
    lengths.push_back(i - start);
    start = i;
  }
  return lengths;
}

template <class Sample>
bool HoldsLastReading(const std::vector<Sample>& samples) {
  const auto count = static_cast<double>(samples.size());
  if (static_cast<double>(RepeatsIn(samples)) < kLeastShareRepeated * count) return false;
  std::vector<std::size_t> runs = RunsOf(samples);
  if (runs.size() < kFewestRuns) return false;
  const auto middle = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2);
  std::ranges::nth_element(runs, middle);
  const std::size_t median = *middle;
  std::size_t in_even_runs = 0;
  for (const std::size_t run : runs) {
    if (run + 1 >= median && run <= median + 1) in_even_runs += run;
  }
  return static_cast<double>(in_even_runs) >= kLeastShareEven * count;
}

/// How many it leaves out.
template <class Sample>
std::size_t LeaveOutRepeats(std::vector<Sample>& samples) {
  const auto repeats = std::ranges::unique(
      samples, [](const Sample& a, const Sample& b) { return SameReading(a, b); });
  const std::size_t count = repeats.size();
  samples.erase(repeats.begin(), repeats.end());
  return count;
}

}  // namespace

std::optional<Recording> WithoutRepeatedReadings(const Recording& recording) {
  const bool fixes = HoldsLastReading(recording.gnss);
  const bool headings = HoldsLastReading(recording.heading);
  if (!fixes && !headings) return std::nullopt;
  Recording own = recording;
  if (fixes) {
    own.rejected.Count(Channel::kGnss, RejectReason::kRepeated, LeaveOutRepeats(own.gnss));
  }
  if (headings) {
    own.rejected.Count(Channel::kHeading, RejectReason::kRepeated, LeaveOutRepeats(own.heading));
  }
  return own;
}

}  // namespace telltale
