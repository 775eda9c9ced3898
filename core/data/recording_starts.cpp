#include "telltale/core/data/recording_starts.hpp"

#include <algorithm>

namespace telltale {

std::vector<double> StartsAfterSilence(const Recording& recording, double silence_s) {
  std::vector<double> times_s;
  const auto note = [&](const auto& samples) {
    for (const auto& sample : samples) times_s.push_back(sample.time_s);
  };
  note(recording.gnss);
  note(recording.heading);
  note(recording.thrusters);
  std::sort(times_s.begin(), times_s.end());
  std::vector<double> starts_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (i == 0 || times_s[i] - times_s[i - 1] > silence_s) starts_s.push_back(times_s[i]);
  }
  return starts_s;
}

}  // namespace telltale
