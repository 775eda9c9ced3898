#include "telltale/core/data/check/input_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/data/check/motion_check.hpp"

namespace telltale {
namespace {

constexpr double kLongestGnssPeriodS = 15.0;      // no receiver for navigation is slower
constexpr double kPeriodOfMicrosecondsS = 1.5e4;  // 15 ms and more, told as microseconds
constexpr double kShareOutside = 0.5;             // of a channel, before its units are doubted
constexpr double kCommandShareOutside = 0.05;
constexpr double kOutsideBy = 1.05;

/// Calls visit(period_s) for each step ahead in time from one sample to the next.
template <class Sample, class Visit>
void ForEachPeriod(const std::vector<Sample>& samples, Visit visit) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double period_s = samples[i].time_s - samples[i - 1].time_s;
    if (std::isfinite(period_s) && period_s > 0.0) visit(period_s);
  }
}

/// 0 where no time follows another.
template <class Sample>
double MedianPeriod(const std::vector<Sample>& samples) {
  std::vector<double> periods;
  periods.reserve(samples.size());
  ForEachPeriod(samples, [&](double period_s) { periods.push_back(period_s); });
  return periods.empty() ? 0.0 : Median(std::move(periods));
}

template <class Sample>
ChannelCheck CheckChannel(const std::vector<Sample>& samples) {
  ChannelCheck check;
  check.samples = samples.size();
  if (samples.empty()) return check;
  check.start_s = samples.front().time_s;
  check.end_s = samples.back().time_s;
  check.median_period_s = MedianPeriod(samples);
  const double gap_s = std::max(1.0, 5.0 * check.median_period_s);
  ForEachPeriod(samples, [&](double period_s) {
    check.gaps += period_s > gap_s ? 1 : 0;
    check.longest_gap_s = std::max(check.longest_gap_s, period_s);
  });
  return check;
}

/// Calls visit(sample) for each sample that is later than those before it.
template <class Sample, class Visit>
void ForEachAscending(const std::vector<Sample>& samples, Visit visit) {
  double newest_s = -std::numeric_limits<double>::infinity();
  for (const Sample& sample : samples) {
    if (!std::isfinite(sample.time_s) || sample.time_s <= newest_s) continue;
    newest_s = sample.time_s;
    visit(sample);
  }
}

/// The samples of a channel whose times ascend, so that one wrong stamp spoils nothing. Where all
/// do, they are not copied: a recording may be as large as memory allows.
template <class Sample>
class Ascending {
 public:
  explicit Ascending(const std::vector<Sample>& samples) : samples_(samples) {
    std::size_t count = 0;
    ForEachAscending(samples, [&](const Sample&) { ++count; });
    is_all_ = count == samples.size();
    if (is_all_) return;
    some_.reserve(count);
    ForEachAscending(samples, [&](const Sample& sample) { some_.push_back(sample); });
  }

  const std::vector<Sample>& Samples() const { return is_all_ ? samples_ : some_; }

 private:
  const std::vector<Sample>& samples_;
  bool is_all_ = false;
  std::vector<Sample> some_;
};

std::optional<Refusal> FaultOfTimes(const ChannelCheck& gnss) {
  const double period_s = gnss.median_period_s;
  if (period_s <= kLongestGnssPeriodS) return std::nullopt;
  const bool is_us = period_s >= kPeriodOfMicrosecondsS;
  return Refusal{"times",
                 std::string("times seem to be in ") + (is_us ? "microseconds" : "milliseconds") +
                     ": positions come every " + FormatNumber(period_s, 0) +
                     " s, if times are in seconds",
                 std::string("divide time_s by ") + (is_us ? "1e6" : "1000")};
}

std::optional<Refusal> FaultOfPositionRange(const std::vector<GnssFix>& gnss) {
  if (gnss.empty()) return std::nullopt;
  const auto outside = std::count_if(gnss.begin(), gnss.end(), [](const GnssFix& fix) {
    return std::abs(fix.latitude_deg) > 90.0 && std::abs(fix.longitude_deg) <= 90.0;
  });
  if (static_cast<double>(outside) <= kShareOutside * static_cast<double>(gnss.size())) {
    return std::nullopt;
  }
  return Refusal{"latitude and longitude",
                 "latitude and longitude seem to be exchanged: " + std::to_string(outside) +
                     " of " + std::to_string(gnss.size()) + " latitudes lie outside [-90, 90]",
                 "exchange the two columns"};
}

std::optional<Refusal> FaultOfCommandUnit(const std::vector<ThrusterSample>& thrusters) {
  if (thrusters.empty()) return std::nullopt;
  const auto are_shares =
      std::count_if(thrusters.begin(), thrusters.end(), [](const ThrusterSample& sample) {
        const bool is_off = sample.port_us == 0.0 && sample.starboard_us == 0.0;
        return !is_off && std::abs(sample.port_us) <= 100.0 &&
               std::abs(sample.starboard_us) <= 100.0;
      });
  if (static_cast<double>(are_shares) > kShareOutside * static_cast<double>(thrusters.size())) {
    return Refusal{"thruster commands",
                   "commands seem to be shares or percent: " + std::to_string(are_shares) + " of " +
                       std::to_string(thrusters.size()) + " lie within [-100, 100]",
                   "give pulse widths in microseconds, [500, 2500]"};
  }
  return std::nullopt;
}

std::optional<Refusal> FaultOfCommandRange(const std::vector<ThrusterSample>& thrusters,
                                           const Vehicle& vehicle) {
  if (thrusters.empty()) return std::nullopt;
  // No pulse at all is an output that is off, which admission rejects.
  const auto is_off = [](double us) { return us == 0.0; };
  const auto is_outside = [](const PwmChannel& channel, double us) {
    const double low = std::min({channel.full_forward_us, channel.full_reverse_us});
    const double high = std::max({channel.full_forward_us, channel.full_reverse_us});
    const double margin = (kOutsideBy - 1.0) * 0.5 * (high - low);
    return us < low - margin || us > high + margin;
  };
  const auto samples = static_cast<double>(thrusters.size());
  const auto outside =
      std::count_if(thrusters.begin(), thrusters.end(), [&](const ThrusterSample& sample) {
        if (is_off(sample.port_us) || is_off(sample.starboard_us)) return false;
        return is_outside(vehicle.port, sample.port_us) ||
               is_outside(vehicle.starboard, sample.starboard_us);
      });
  if (static_cast<double>(outside) <= kCommandShareOutside * samples) return std::nullopt;
  return Refusal{"thruster commands",
                 FormatNumber(100.0 * static_cast<double>(outside) / samples, 0) +
                     " % of the commands lie outside the range of the vehicle file",
                 "set full_forward_us and full_reverse_us to the widest pulses"};
}

}  // namespace

InputCheck CheckInput(const std::vector<GnssFix>& gnss, const std::vector<HeadingSample>& heading,
                      const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle) {
  InputCheck check;
  check.channels = {CheckChannel(gnss), CheckChannel(heading), CheckChannel(thrusters)};
  if (auto fault = UnitFault(gnss, thrusters)) {
    check.faults.push_back(*std::move(fault));
    return check;
  }
  const Ascending fixes(gnss);
  const Ascending headings(heading);
  const Ascending commands(thrusters);
  for (Refusal& fault :
       MotionFaults(fixes.Samples(), headings.Samples(), commands.Samples(), vehicle)) {
    check.faults.push_back(std::move(fault));
  }
  if (auto fault = FaultOfCommandRange(commands.Samples(), vehicle)) check.faults.push_back(*fault);
  return check;
}

std::optional<Refusal> UnitFault(const std::vector<GnssFix>& gnss,
                                 const std::vector<ThrusterSample>& thrusters) {
  if (auto fault = FaultOfTimes(CheckChannel(gnss))) return fault;
  if (auto fault = FaultOfPositionRange(gnss)) return fault;
  return FaultOfCommandUnit(thrusters);
}

std::optional<Refusal> FirstFault(const InputCheck& check) {
  return check.faults.empty() ? std::nullopt : std::optional(check.faults.front());
}

}  // namespace telltale
