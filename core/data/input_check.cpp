#include "telltale/core/data/input_check.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/data/heading_unwrap.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/time_series.hpp"

namespace telltale {
namespace {

constexpr double kLongestGnssPeriodS = 15.0;      // no receiver for navigation is slower
constexpr double kPeriodOfMicrosecondsS = 1.5e4;  // 15 ms and more, told as microseconds
constexpr double kShareOutside = 0.5;             // of a channel, before its units are doubted
constexpr double kChordS = 1.0;                   // over which a course is taken
constexpr double kSlowestMps = 0.3;               // below it a course is mostly noise
constexpr double kForward = 0.1;                  // mean command that counts as pushing ahead
constexpr std::size_t kFewestCourses = 20;
constexpr double kConcentrated = 0.7;    // resultant length
constexpr double kBetterBy = 0.25;       // of resultant lengths
constexpr double kSpreadHeadings = 0.8;  // resultant length below which headings differ
constexpr double kTurnedRoundDeg = 120.0;
constexpr double kAlongDeg = 45.0;      // course less heading of a boat that drives where it heads
constexpr double kElsewhereDeg = 60.0;  // and of one that plainly does not
constexpr double kYawLagS = 1.0;        // of a small boat's yaw rate behind its commands
constexpr double kSurgeLagS = 3.0;      // and of its speed
constexpr double kSure = 4.0;           // standard errors
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

/// The commands behind a first-order lag, at any time.
class LaggedCommands {
 public:
  LaggedCommands(const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle,
                 double lag_s) {
    std::vector<double> times_s;
    std::vector<double> port;
    std::vector<double> starboard;
    PropellerCommand state;
    PropellerCommand held;
    for (const ThrusterSample& sample : thrusters) {
      const PropellerCommand command = vehicle.Normalise(sample.port_us, sample.starboard_us);
      if (!times_s.empty()) {
        const double kept = std::exp(-(sample.time_s - times_s.back()) / lag_s);
        state = {held.port + kept * (state.port - held.port),
                 held.starboard + kept * (state.starboard - held.starboard)};
      } else {
        state = command;
      }
      held = command;
      times_s.push_back(sample.time_s);
      port.push_back(state.port);
      starboard.push_back(state.starboard);
    }
    port_ = {times_s, port};
    starboard_ = {times_s, starboard};
  }

  PropellerCommand At(double t) const { return {port_.Linear(t), starboard_.Linear(t)}; }

 private:
  TimeSeries port_;
  TimeSeries starboard_;
};

/// The boat over one chord between fixes.
struct Chord {
  double time_s = 0.0;
  double speed_mps = 0.0;
  double course_rad = 0.0;
  double psi_rad = 0.0;  ///< measured heading in the middle
};

std::vector<Chord> ChordsOf(const std::vector<GnssFix>& gnss, const TimeSeries& psi) {
  std::vector<Chord> chords;
  if (gnss.empty()) return chords;
  const NorthEastFrame frame({gnss.front().latitude_deg, gnss.front().longitude_deg});
  for (std::size_t i = 0, j = 0; j < gnss.size(); ++j) {
    const double span_s = gnss[j].time_s - gnss[i].time_s;
    if (span_s < kChordS) continue;
    const double middle_s = 0.5 * (gnss[i].time_s + gnss[j].time_s);
    if (span_s < 3.0 * kChordS && psi.times_s.front() <= middle_s &&
        middle_s <= psi.times_s.back()) {
      const auto from = frame.Forward({gnss[i].latitude_deg, gnss[i].longitude_deg});
      const auto to = frame.Forward({gnss[j].latitude_deg, gnss[j].longitude_deg});
      const double north = (to.north_m - from.north_m) / span_s;
      const double east = (to.east_m - from.east_m) / span_s;
      chords.push_back(
          {middle_s, std::hypot(north, east), std::atan2(east, north), psi.Linear(middle_s)});
    }
    i = j;
  }
  return chords;
}

/// Mean direction and resultant length of angles, weighted.
struct Resultant {
  double length = 0.0;
  double mean_deg = 0.0;
};

template <class Angle>
Resultant ResultantOf(const std::vector<Chord>& chords, Angle angle) {
  std::complex<double> sum = 0.0;
  double weight = 0.0;
  for (const Chord& chord : chords) {
    sum += std::polar(chord.speed_mps, angle(chord));
    weight += chord.speed_mps;
  }
  if (weight <= 0.0) return {};
  return {std::abs(sum) / weight, std::arg(sum) / kRadiansPerDegree};
}

/// Slopes of a quantity on the two lagged commands, in standard errors.
struct CommandSigns {
  double port = 0.0;
  double starboard = 0.0;
};

CommandSigns SignsOf(const std::vector<double>& times_s, const std::vector<double>& values,
                     const LaggedCommands& commands, double lag_s) {
  const auto n = static_cast<Eigen::Index>(times_s.size());
  if (n < 10) return {};
  Eigen::MatrixXd columns(n, 3);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PropellerCommand command = commands.At(times_s[static_cast<std::size_t>(i)]);
    columns.row(i) << command.port, command.starboard, 1.0;
    y[i] = values[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d gram = columns.transpose() * columns;
  const Eigen::LDLT<Eigen::Matrix3d> solver(gram);
  if (solver.info() != Eigen::Success || solver.rcond() < 1e-9) return {};
  const Eigen::Vector3d slope = solver.solve(columns.transpose() * y);
  const double span_s = times_s.back() - times_s.front();
  const double independent = std::min(static_cast<double>(n), span_s / (2.0 * lag_s));
  const double variance = (y - columns * slope).squaredNorm() / static_cast<double>(n);
  const Eigen::Matrix3d covariance = solver.solve(Eigen::Matrix3d::Identity()) * variance *
                                     (static_cast<double>(n) / std::max(1.0, independent));
  const auto in_errors = [&](int i) {
    return slope[i] / std::sqrt(std::max(1e-300, covariance(i, i)));
  };
  return {in_errors(0), in_errors(1)};
}

int Sign(double in_standard_errors) {
  return in_standard_errors > kSure ? 1 : in_standard_errors < -kSure ? -1 : 0;
}

std::string Degrees(double degrees) {
  return FormatNumber(degrees, 0) + " degrees";
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
  const auto is_outside = [](const PwmChannel& channel, double us) {
    const double low = std::min({channel.full_forward_us, channel.full_reverse_us});
    const double high = std::max({channel.full_forward_us, channel.full_reverse_us});
    const double margin = (kOutsideBy - 1.0) * 0.5 * (high - low);
    return us < low - margin || us > high + margin;
  };
  const auto samples = static_cast<double>(thrusters.size());
  const auto outside =
      std::count_if(thrusters.begin(), thrusters.end(), [&](const ThrusterSample& sample) {
        return is_outside(vehicle.port, sample.port_us) ||
               is_outside(vehicle.starboard, sample.starboard_us);
      });
  if (static_cast<double>(outside) <= kCommandShareOutside * samples) return std::nullopt;
  return Refusal{"thruster commands",
                 FormatNumber(100.0 * static_cast<double>(outside) / samples, 0) +
                     " % of the commands lie outside the range of the vehicle file",
                 "set full_forward_us and full_reverse_us to the widest pulses"};
}

std::optional<Refusal> FaultOfHeadingUnit(const std::vector<HeadingSample>& heading,
                                          const std::vector<Chord>& ahead) {
  double low = 0.0;
  double high = 0.0;
  for (const HeadingSample& sample : heading) {
    low = std::min(low, sample.heading_deg);
    high = std::max(high, sample.heading_deg);
  }
  if (high - low > 2.1 * std::numbers::pi || high - low < 1.0) return std::nullopt;
  const auto as_degrees = [](const Chord& c) { return c.course_rad - c.psi_rad; };
  const auto as_radians = [](const Chord& c) {
    return c.course_rad - c.psi_rad / kRadiansPerDegree;
  };
  const Resultant degrees = ResultantOf(ahead, as_degrees);
  const Resultant radians = ResultantOf(ahead, as_radians);
  const bool follows = radians.length > kConcentrated && std::abs(radians.mean_deg) < kAlongDeg;
  const bool follows_better =
      radians.length > degrees.length + kBetterBy || std::abs(degrees.mean_deg) > kElsewhereDeg;
  if (ahead.size() < kFewestCourses || !follows || !follows_better) return std::nullopt;
  return Refusal{"heading",
                 "headings seem to be in radians: all lie within " + FormatNumber(low, 2) + " to " +
                     FormatNumber(high, 2) + ", and the course follows them only as radians",
                 "give headings in degrees"};
}

std::optional<Refusal> FaultOfHeadingSense(const std::vector<Chord>& ahead, int yaw_sign) {
  if (ahead.size() < kFewestCourses) return std::nullopt;
  const Resultant headings = ResultantOf(ahead, [](const Chord& c) { return c.psi_rad; });
  const Resultant same =
      ResultantOf(ahead, [](const Chord& c) { return c.course_rad - c.psi_rad; });
  const Resultant mirrored =
      ResultantOf(ahead, [](const Chord& c) { return c.course_rad + c.psi_rad; });
  const bool is_mirrored = headings.length < kSpreadHeadings && mirrored.length > kConcentrated &&
                           mirrored.length > same.length + kBetterBy;
  if (is_mirrored) {
    const std::string evidence = ": course plus heading keeps to " + Degrees(mirrored.mean_deg) +
                                 " (resultant " + FormatNumber(mirrored.length, 2) +
                                 "), course less heading to nothing (" +
                                 FormatNumber(same.length, 2) + ")";
    const bool is_from_east = std::abs(mirrored.mean_deg - 90.0) < 45.0;
    if (is_from_east && yaw_sign > 0) {
      return Refusal{"latitude and longitude",
                     "latitude and longitude seem to be exchanged" + evidence,
                     "exchange the two columns"};
    }
    if (is_from_east) {
      return Refusal{"heading", "headings seem to be counted from east, anticlockwise" + evidence,
                     "give 90 degrees less the heading"};
    }
    return Refusal{"heading", "headings seem to be mirrored" + evidence,
                   "count headings clockwise from north"};
  }
  const bool is_turned = same.length > kConcentrated && std::abs(same.mean_deg) > kTurnedRoundDeg;
  if (is_turned && yaw_sign > 0) {
    return Refusal{"heading",
                   "headings seem to be turned round: under forward commands the course differs "
                   "from the heading by " +
                       Degrees(same.mean_deg),
                   "add 180 degrees to the headings"};
  }
  return std::nullopt;
}

/// Whether the course follows the heading over headings that differ.
bool HeadingIsConfirmed(const std::vector<Chord>& ahead) {
  if (ahead.size() < kFewestCourses) return false;
  const Resultant headings = ResultantOf(ahead, [](const Chord& c) { return c.psi_rad; });
  const Resultant same =
      ResultantOf(ahead, [](const Chord& c) { return c.course_rad - c.psi_rad; });
  return headings.length < kSpreadHeadings && same.length > kConcentrated &&
         std::abs(same.mean_deg) < kAlongDeg;
}

std::optional<Refusal> FaultOfThrusters(const CommandSigns& yaw, const CommandSigns& surge,
                                        bool heading_is_confirmed) {
  const int yaw_port = Sign(yaw.port);
  const int yaw_starboard = Sign(yaw.starboard);
  const int surge_port = Sign(surge.port);
  const int surge_starboard = Sign(surge.starboard);
  const auto evidence = [&] {
    return ": in standard errors yaw rate goes with port by " + FormatNumber(yaw.port, 0) +
           " and with starboard by " + FormatNumber(yaw.starboard, 0) + ", speed by " +
           FormatNumber(surge.port, 0) + " and " + FormatNumber(surge.starboard, 0) +
           " (+ - + + is right)";
  };
  const char* const exchange = "exchange full_forward_us and full_reverse_us of ";
  if (yaw_port < 0 && yaw_starboard > 0) {
    if (surge_port < 0 && surge_starboard < 0) {
      return Refusal{"thrusters", "both thrusters seem to be reversed" + evidence(),
                     std::string(exchange) + "both thrusters"};
    }
    if (surge.port > 0.0 && surge.starboard > 0.0) {
      return Refusal{"thrusters",
                     std::string("the thrusters seem to be swapped") +
                         (heading_is_confirmed ? "" : ", or headings mirrored") + evidence(),
                     heading_is_confirmed ? "exchange port and starboard"
                                          : "exchange port and starboard, or count headings "
                                            "clockwise from north"};
    }
  }
  if (yaw_port < 0 && yaw_starboard < 0 && surge_starboard > 0 && surge_port <= 0) {
    return Refusal{"port thruster", "the port thruster seems to be reversed" + evidence(),
                   std::string(exchange) + "the port thruster"};
  }
  if (yaw_port > 0 && yaw_starboard > 0 && surge_port > 0 && surge_starboard <= 0) {
    return Refusal{"starboard thruster", "the starboard thruster seems to be reversed" + evidence(),
                   std::string(exchange) + "the starboard thruster"};
  }
  return std::nullopt;
}

/// Yaw rates half a second apart, by the slope of the unwrapped heading.
void YawRates(const TimeSeries& psi, std::vector<double>& times_s, std::vector<double>& rates) {
  constexpr double kStepS = 0.5;
  for (double t = psi.times_s.front() + 0.5 * kStepS; t + 0.5 * kStepS <= psi.times_s.back();
       t += kStepS) {
    times_s.push_back(t);
    rates.push_back((psi.Linear(t + 0.5 * kStepS) - psi.Linear(t - 0.5 * kStepS)) / kStepS);
  }
}

void CheckMotion(const std::vector<GnssFix>& gnss, const std::vector<HeadingSample>& heading,
                 const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle,
                 std::vector<Refusal>& faults) {
  std::vector<double> heading_times_s;
  for (const HeadingSample& sample : heading) heading_times_s.push_back(sample.time_s);
  const TimeSeries psi{heading_times_s, Unwrap(heading)};
  const std::vector<Chord> chords = ChordsOf(gnss, psi);
  const LaggedCommands at_yaw(thrusters, vehicle, kYawLagS);
  const LaggedCommands at_surge(thrusters, vehicle, kSurgeLagS);

  std::vector<Chord> ahead;
  for (const Chord& chord : chords) {
    if (chord.speed_mps > kSlowestMps && at_surge.At(chord.time_s).Mean() > kForward) {
      ahead.push_back(chord);
    }
  }
  if (auto fault = FaultOfHeadingUnit(heading, ahead)) {
    faults.push_back(*std::move(fault));
    return;
  }

  std::vector<double> yaw_times_s;
  std::vector<double> yaw_rates;
  YawRates(psi, yaw_times_s, yaw_rates);
  const CommandSigns yaw = SignsOf(yaw_times_s, yaw_rates, at_yaw, kYawLagS);
  const int yaw_sign = Sign(yaw.port) > 0 && Sign(yaw.starboard) < 0   ? 1
                       : Sign(yaw.port) < 0 && Sign(yaw.starboard) > 0 ? -1
                                                                       : 0;
  if (auto fault = FaultOfHeadingSense(ahead, yaw_sign)) {
    faults.push_back(*std::move(fault));
    return;  // speed ahead is told by heading, so that signs of thrusters would mislead
  }

  std::vector<double> surge_times_s;
  std::vector<double> surge_speeds;
  for (const Chord& chord : chords) {
    surge_times_s.push_back(chord.time_s);
    surge_speeds.push_back(chord.speed_mps * std::cos(chord.course_rad - chord.psi_rad));
  }
  const CommandSigns surge = SignsOf(surge_times_s, surge_speeds, at_surge, kSurgeLagS);
  if (auto fault = FaultOfThrusters(yaw, surge, HeadingIsConfirmed(ahead)))
    faults.push_back(*std::move(fault));
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
  auto range = FaultOfCommandRange(commands, vehicle);
  if (!fixes.empty() && !headings.empty() && !commands.empty()) {
    CheckMotion(fixes, headings, commands, vehicle, check.faults);
  }
  if (range) check.faults.push_back(*std::move(range));
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
