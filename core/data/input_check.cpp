#include "telltale/core/data/input_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/data/motion_check.hpp"

namespace telltale {
namespace {

constexpr double kLongestGnssPeriodS = 15.0;      // no receiver for navigation is slower
constexpr double kPeriodOfMicrosecondsS = 1.5e4;  // 15 ms and more, told as microseconds
constexpr double kShareOutside = 0.5;             // of a channel, before its units are doubted
constexpr double kCommandShareOutside = 0.05;
constexpr double kOutsideBy = 1.05;

template <class Sample>
ChannelCheck CheckChannel(const std::vector<Sample>& samples) {
  ChannelCheck check;
  check.samples = samples.size();
  if (samples.empty()) return check;
  check.start_s = samples.front().time_s;
  check.end_s = samples.back().time_s;
  std::vector<double> periods;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double period_s = samples[i].time_s - samples[i - 1].time_s;
    if (std::isfinite(period_s) && period_s > 0.0) periods.push_back(period_s);
  }
  if (periods.empty()) return check;
  check.median_period_s = Median(periods);
  const double gap_s = std::max(1.0, 5.0 * check.median_period_s);
  for (const double period_s : periods) {
    check.gaps += period_s > gap_s ? 1 : 0;
    check.longest_gap_s = std::max(check.longest_gap_s, period_s);
  }
  return check;
}

/// The samples of a channel whose times ascend, so that one wrong stamp spoils nothing.
template <class Sample>
std::vector<Sample> Ascending(const std::vector<Sample>& samples) {
  std::vector<Sample> ascending;
  for (const Sample& sample : samples) {
    if (!std::isfinite(sample.time_s)) continue;
    if (ascending.empty() || sample.time_s > ascending.back().time_s) ascending.push_back(sample);
  }
  return ascending;
}

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
  const auto fixes = Ascending(gnss);
  const auto headings = Ascending(heading);
  const auto commands = Ascending(thrusters);
  for (Refusal& fault : MotionFaults(fixes, headings, commands, vehicle)) {
    check.faults.push_back(std::move(fault));
  }
  if (auto fault = FaultOfCommandRange(commands, vehicle)) check.faults.push_back(*fault);
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
