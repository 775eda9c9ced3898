#include "telltale/core/data/prepare_options.hpp"

#include <algorithm>
#include <string>

#include "telltale/core/base/range.hpp"

namespace telltale {

std::string_view Name(Preset preset) {
  switch (preset) {
    case Preset::kUnknown: return "UNKNOWN";
    case Preset::kPaper: return "PAPER";
    case Preset::kRobust: return "ROBUST";
  }
  return "";
}

PrepareOptions PrepareOptions::Paper() {
  PrepareOptions options;
  options.preset = Preset::kPaper;
  options.smoothing_half_width = 5;  // the paper does not say
  return options;
}

PrepareOptions PrepareOptions::Robust() {
  return {};
}

std::optional<Refusal> PrepareOptions::Validate() const {
  const std::string_view subject = "data preparation";
  const auto half_width = static_cast<double>(smoothing_half_width);
  const auto degree = static_cast<double>(smoothing_degree);
  if (preset == Preset::kUnknown) {
    return Refusal{std::string(subject), "preset is unknown", "set preset to paper or robust"};
  }
  if (sampling_period_s) {
    if (auto r = OutOfRange(subject, "sampling_period_s", *sampling_period_s, kShortestPeriodS,
                            kLongestPeriodS)) {
      return r;
    }
  }
  if (auto r = OutOfRange(subject, "smoothing_half_width", half_width, 2, 50)) return r;
  if (auto r = OutOfRange(subject, "smoothing_degree", degree, 1, std::min(5.0, 2 * half_width))) {
    return r;
  }
  if (auto r = OutOfRange(subject, "longest_gap_s", longest_gap_s, 0.1, 60.0)) return r;
  if (auto r = OutOfRange(subject, "shortest_segment_s", shortest_segment_s, 1.0, 600.0)) return r;
  if (auto r = OutOfRange(subject, "longest_slice_s", longest_slice_s, 2.0, 600.0)) return r;
  if (!longest_segment_s) return std::nullopt;
  return OutOfRange(subject, "longest_segment_s", *longest_segment_s, 10.0, 86400.0);
}

}  // namespace telltale
