#include "telltale/core/data/check/supposed_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

constexpr double kYawStepS = 0.5;       // between yaw rates
constexpr double kSureGain = 8.0;       // of log-likelihood, over the recording as it is
constexpr double kYawShare = 0.1;       // of the square that a true relation explains at least
constexpr double kVelocityShare = 0.3;  // the same of velocity

enum class HeadingRule { kAsIs, kMirrored, kFromEast, kFromEastClockwise, kTurnedRound, kRadians };
enum class ThrusterRule { kAsIs, kSwapped, kBothReversed, kPortReversed, kStarboardReversed };

/// What undoes one supposed fault, and how it is told.
struct SupposedFault {
  HeadingRule heading = HeadingRule::kAsIs;
  ThrusterRule thrusters = ThrusterRule::kAsIs;
  bool positions_exchanged = false;
  const char* subject = "";
  const char* reason = "";
  const char* advice = "";
};

constexpr std::array kSupposedFaults = {
    SupposedFault{HeadingRule::kRadians, ThrusterRule::kAsIs, false, "heading",
                  "headings seem to be in radians", "give headings in degrees"},
    SupposedFault{HeadingRule::kMirrored, ThrusterRule::kAsIs, false, "heading",
                  "headings seem to be mirrored", "count headings clockwise from north"},
    SupposedFault{HeadingRule::kFromEast, ThrusterRule::kAsIs, false, "heading",
                  "headings seem to be counted from east, anticlockwise",
                  "give 90 degrees less the heading"},
    SupposedFault{HeadingRule::kFromEastClockwise, ThrusterRule::kAsIs, false, "heading",
                  "headings seem to be counted from east, clockwise",
                  "add 90 degrees to the headings"},
    SupposedFault{
        HeadingRule::kTurnedRound, ThrusterRule::kAsIs, false, "heading",
        "headings seem to be turned round, or the thrusters to be both swapped and reversed",
        "add 180 degrees to the headings; if they are right, exchange port and starboard, "
        "and full_forward_us and full_reverse_us of both"},
    SupposedFault{HeadingRule::kAsIs, ThrusterRule::kAsIs, true, "latitude and longitude",
                  "latitude and longitude seem to be exchanged", "exchange the two columns"},
    SupposedFault{HeadingRule::kAsIs, ThrusterRule::kSwapped, false, "thrusters",
                  "the thrusters seem to be swapped", "exchange port and starboard"},
    SupposedFault{HeadingRule::kAsIs, ThrusterRule::kBothReversed, false, "thrusters",
                  "both thrusters seem to be reversed",
                  "exchange full_forward_us and full_reverse_us of both thrusters"},
    SupposedFault{HeadingRule::kAsIs, ThrusterRule::kPortReversed, false, "port thruster",
                  "the port thruster seems to be reversed",
                  "exchange full_forward_us and full_reverse_us of the port thruster"},
    SupposedFault{HeadingRule::kAsIs, ThrusterRule::kStarboardReversed, false, "starboard thruster",
                  "the starboard thruster seems to be reversed",
                  "exchange full_forward_us and full_reverse_us of the starboard thruster"}};

double Undone(HeadingRule rule, double heading_deg) {
  switch (rule) {
    case HeadingRule::kAsIs: break;
    case HeadingRule::kMirrored: return -heading_deg;
    case HeadingRule::kFromEast: return 90.0 - heading_deg;
    case HeadingRule::kFromEastClockwise: return heading_deg + 90.0;
    case HeadingRule::kTurnedRound: return heading_deg + 180.0;
    case HeadingRule::kRadians: return heading_deg / kRadiansPerDegree;
  }
  return heading_deg;
}

PropellerCommand Undone(ThrusterRule rule, const PropellerCommand& command) {
  switch (rule) {
    case ThrusterRule::kAsIs: break;
    case ThrusterRule::kSwapped: return {command.starboard, command.port};
    case ThrusterRule::kBothReversed: return {-command.port, -command.starboard};
    case ThrusterRule::kPortReversed: return {-command.port, command.starboard};
    case ThrusterRule::kStarboardReversed: return {command.port, -command.starboard};
  }
  return command;
}

/// Sums of a line through the origin whose slope is not negative.
class PositiveLine {
 public:
  void Add(double x, double y) {
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
  }
  void AddUnexplained(double y) { yy_ += y * y; }
  /// Share of the square of y that stays.
  double Rest() const { return RestAfter(std::max(0.0, xy_) * std::max(0.0, xy_)); }
  /// The same where a line of either slope along another direction explains y as well.
  double RestBeside(const PositiveLine& other) const {
    return RestAfter(xy_ * xy_ + other.xy_ * other.xy_);
  }

 private:
  double RestAfter(double square_of_xy) const {
    if (yy_ <= 0.0) return 1.0;
    const double explained = xx_ > 0.0 ? square_of_xy / xx_ : 0.0;
    return std::max(1e-9, 1.0 - explained / yy_);
  }

  double xx_ = 0.0;
  double xy_ = 0.0;
  double yy_ = 0.0;
};

/// Shares of the squares of yaw rate and velocity that the commands leave.
struct Rests {
  double yaw = 1.0;
  double velocity = 1.0;
  double velocity_turned = 1.0;  ///< the same with all headings turned by the angle that fits best
};

/// Yaw rates over the difference of the commands.
PositiveLine YawOverDifference(const SupposedFault& undone, const HeadingSeries& psi,
                               LaggedCommands commands) {
  PositiveLine yaw;
  for (double t = psi.StartTime(); t + kYawStepS <= psi.EndTime(); t += kYawStepS) {
    const double next_s = psi.TimeAfter(t);
    if (next_s - t > RecordedMotion::kWidestChordS) {
      t = next_s - kYawStepS;
      continue;
    }
    const PropellerCommand command = Undone(undone.thrusters, commands.At(t + 0.5 * kYawStepS));
    yaw.Add(command.Difference(), (psi.At(t + kYawStepS) - psi.At(t)) / kYawStepS);
  }
  return yaw;
}

/// What the commands leave once the supposed fault is undone.
Rests RestsWithout(const SupposedFault& supposed, const RecordedMotion& motion) {
  const HeadingSeries psi(
      motion.Headings(), [&](double heading_deg) { return Undone(supposed.heading, heading_deg); });
  LaggedCommands commands = motion.CommandsAtSpeed();
  PositiveLine velocity;
  PositiveLine across;
  for (Velocity v : motion.Velocities()) {
    if (!psi.Covers(v.time_s)) continue;
    if (supposed.positions_exchanged) std::swap(v.north_mps, v.east_mps);
    const double angle = psi.At(v.time_s);
    const PropellerCommand command = Undone(supposed.thrusters, commands.At(v.time_s));
    const double ahead_mps = v.north_mps * std::cos(angle) + v.east_mps * std::sin(angle);
    const double across_mps = v.east_mps * std::cos(angle) - v.north_mps * std::sin(angle);
    velocity.Add(command.Mean(), ahead_mps);
    velocity.AddUnexplained(across_mps);
    across.Add(command.Mean(), across_mps);
  }
  return {YawOverDifference(supposed, psi, motion.CommandsAtYaw()).Rest(), velocity.Rest(),
          velocity.RestBeside(across)};
}

/// Headings that could be radians: none beyond a turn, and more than one value.
bool CouldBeRadians(const std::vector<HeadingSample>& heading) {
  const auto [low, high] = std::minmax_element(
      heading.begin(), heading.end(),
      [](const auto& a, const auto& b) { return a.heading_deg < b.heading_deg; });
  return std::abs(low->heading_deg) < 2.1 * std::numbers::pi &&
         std::abs(high->heading_deg) < 2.1 * std::numbers::pi &&
         high->heading_deg - low->heading_deg > 1.0;
}

std::string Percent(double share) {
  return FormatNumber(100.0 * share, 0) + " %";
}

Refusal Told(const SupposedFault& supposed, const Rests& as_is, const Rests& undone) {
  return {supposed.subject,
          std::string(supposed.reason) + ": the commands explain " + Percent(1.0 - undone.yaw) +
              " of the yaw rate and " + Percent(1.0 - undone.velocity) +
              " of the velocity without this fault, " + Percent(1.0 - as_is.yaw) + " and " +
              Percent(1.0 - as_is.velocity) + " of the input as it is",
          supposed.advice};
}

}  // namespace

std::optional<Refusal> LikeliestSupposedFault(const RecordedMotion& motion) {
  if (std::min(motion.EffectiveYawRates(), motion.EffectiveVelocities()) <
      RecordedMotion::kFewestEffective) {
    return std::nullopt;
  }
  const Rests as_is = RestsWithout({}, motion);
  const bool could_be_radians = CouldBeRadians(motion.Headings());
  const SupposedFault* best = nullptr;
  Rests best_rests;
  double best_gain = kSureGain;
  for (const SupposedFault& supposed : kSupposedFaults) {
    if (supposed.heading == HeadingRule::kRadians && !could_be_radians) continue;
    const Rests rests = RestsWithout(supposed, motion);
    // Yaw rate is one number, velocity two.
    const double gain = 0.5 * motion.EffectiveYawRates() * std::log(as_is.yaw / rests.yaw) +
                        motion.EffectiveVelocities() * std::log(as_is.velocity / rests.velocity);
    const bool explains = 1.0 - rests.yaw > kYawShare && 1.0 - rests.velocity > kVelocityShare;
    if (gain <= best_gain || !explains) continue;
    best = &supposed;
    best_rests = rests;
    best_gain = gain;
    // Headings that all lie within a turn of radians vary by no more than six degrees: turned by a
    // right angle they may explain a short recording as well.
    if (supposed.heading == HeadingRule::kRadians) break;
  }
  if (best == nullptr) return std::nullopt;
  // Headings that are off by a constant angle let faults of another kind seem likely.
  const bool is_turn = best->heading == HeadingRule::kFromEastClockwise ||
                       best->heading == HeadingRule::kTurnedRound;
  const double turned_gain =
      motion.EffectiveVelocities() * std::log(as_is.velocity / as_is.velocity_turned);
  if (!is_turn && turned_gain > best_gain + kSureGain) return std::nullopt;
  return Told(*best, as_is, best_rests);
}

}  // namespace telltale
