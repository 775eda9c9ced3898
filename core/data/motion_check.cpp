#include "telltale/core/data/motion_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <utility>

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/base/format_number.hpp"
#include "telltale/core/data/heading_unwrap.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/time_series.hpp"

namespace telltale {
namespace {

constexpr double kYawLagS = 1.0;          // of a small boat's yaw rate behind its commands
constexpr double kSpeedLagS = 3.0;        // and of its speed
constexpr double kYawStepS = 0.5;         // between yaw rates
constexpr double kChordS = 1.0;           // over which a velocity is taken
constexpr double kWidestChordS = 3.0;     // across a gap there is no velocity and no yaw rate
constexpr double kSureGain = 8.0;         // of log-likelihood, over the recording as it is
constexpr double kYawShare = 0.1;         // of the square that a true relation explains at least
constexpr double kVelocityShare = 0.3;    // the same of velocity
constexpr double kFewestEffective = 4.0;  // samples without which nothing is told
constexpr double kSlowestMps = 0.3;       // below it a course is mostly noise
constexpr double kAhead = 0.1;            // mean command that counts as pushing ahead
constexpr double kSpreadHeadings = 0.8;   // resultant length below which headings lie all around
constexpr double kConcentrated = 0.7;     // resultant length of courses that follow headings
constexpr double kConstantAngleDeg = 15.0;
constexpr double kSureErrors = 4.0;
constexpr double kStuckS = 10.0;
constexpr double kTurning = 0.15;        // difference of commands that turns any boat
constexpr std::size_t kFewestMoves = 3;  // of the other thruster, for one that never moves

// ---- signals ------------------------------------------------------------------------------------

PropellerCommand Between(const PropellerCommand& from, const PropellerCommand& to, double share) {
  return {from.port + share * (to.port - from.port),
          from.starboard + share * (to.starboard - from.starboard)};
}

/// The commands behind a first-order lag, linear between their stamps and held beyond the ends.
/// They are gone through once, so that no copy of them stands in memory. Requires: a command.
class LaggedCommands {
 public:
  LaggedCommands(const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle, double lag_s)
      : thrusters_(thrusters), vehicle_(vehicle), lag_s_(lag_s), told_(Told(0)), next_(told_) {}

  /// Requires: a time not before the one asked for last.
  PropellerCommand At(double t) {
    while (at_ < thrusters_.size() && thrusters_[at_].time_s <= t) Advance();
    if (at_ == 0) return next_;
    if (at_ == thrusters_.size()) return last_;
    const double since_s = thrusters_[at_ - 1].time_s;
    return Between(last_, next_, (t - since_s) / (thrusters_[at_].time_s - since_s));
  }

 private:
  PropellerCommand Told(std::size_t i) const {
    return vehicle_.Normalise(thrusters_[i].port_us, thrusters_[i].starboard_us);
  }

  void Advance() {
    last_ = next_;
    if (++at_ == thrusters_.size()) return;
    const double held_s = thrusters_[at_].time_s - thrusters_[at_ - 1].time_s;
    next_ = Between(told_, last_, std::exp(-held_s / lag_s_));
    told_ = Told(at_);
  }

  const std::vector<ThrusterSample>& thrusters_;
  const Vehicle& vehicle_;
  double lag_s_;
  std::size_t at_ = 0;     ///< the command that comes next
  PropellerCommand told_;  ///< at its stamp, without the lag
  PropellerCommand next_;  ///< at its stamp
  PropellerCommand last_;  ///< at the stamp before
};

/// The boat's velocity over one chord between fixes.
struct Velocity {
  double time_s = 0.0;
  double span_s = 0.0;
  double north_mps = 0.0;
  double east_mps = 0.0;
};

std::vector<Velocity> VelocitiesOf(const std::vector<GnssFix>& gnss) {
  std::vector<Velocity> velocities;
  if (gnss.empty()) return velocities;
  const NorthEastFrame frame({gnss.front().latitude_deg, gnss.front().longitude_deg});
  for (std::size_t i = 0, j = 0; j < gnss.size(); ++j) {
    const double span_s = gnss[j].time_s - gnss[i].time_s;
    if (span_s < kChordS) continue;
    if (span_s < kWidestChordS) {
      const auto from = frame.Forward({gnss[i].latitude_deg, gnss[i].longitude_deg});
      const auto to = frame.Forward({gnss[j].latitude_deg, gnss[j].longitude_deg});
      velocities.push_back({0.5 * (gnss[i].time_s + gnss[j].time_s), span_s,
                            (to.north_m - from.north_m) / span_s,
                            (to.east_m - from.east_m) / span_s});
    }
    i = j;
  }
  return velocities;
}

// ---- supposed faults ----------------------------------------------------------------------------

enum class HeadingRule { kAsIs, kMirrored, kFromEast, kFromEastClockwise, kTurnedRound, kRadians };
enum class ThrusterRule { kAsIs, kSwapped, kBothReversed, kPortReversed, kStarboardReversed };

/// What undoes one supposed fault, and how it is told.
struct Supposition {
  HeadingRule heading = HeadingRule::kAsIs;
  ThrusterRule thrusters = ThrusterRule::kAsIs;
  bool positions_exchanged = false;
  const char* subject = "";
  const char* reason = "";
  const char* advice = "";
};

constexpr std::array kSuppositions = {
    Supposition{HeadingRule::kRadians, ThrusterRule::kAsIs, false, "heading",
                "headings seem to be in radians", "give headings in degrees"},
    Supposition{HeadingRule::kMirrored, ThrusterRule::kAsIs, false, "heading",
                "headings seem to be mirrored", "count headings clockwise from north"},
    Supposition{HeadingRule::kFromEast, ThrusterRule::kAsIs, false, "heading",
                "headings seem to be counted from east, anticlockwise",
                "give 90 degrees less the heading"},
    Supposition{HeadingRule::kFromEastClockwise, ThrusterRule::kAsIs, false, "heading",
                "headings seem to be counted from east, clockwise",
                "add 90 degrees to the headings"},
    Supposition{
        HeadingRule::kTurnedRound, ThrusterRule::kAsIs, false, "heading",
        "headings seem to be turned round, or the thrusters to be both swapped and reversed",
        "add 180 degrees to the headings; if they are right, exchange port and starboard, "
        "and full_forward_us and full_reverse_us of both"},
    Supposition{HeadingRule::kAsIs, ThrusterRule::kAsIs, true, "latitude and longitude",
                "latitude and longitude seem to be exchanged", "exchange the two columns"},
    Supposition{HeadingRule::kAsIs, ThrusterRule::kSwapped, false, "thrusters",
                "the thrusters seem to be swapped", "exchange port and starboard"},
    Supposition{HeadingRule::kAsIs, ThrusterRule::kBothReversed, false, "thrusters",
                "both thrusters seem to be reversed",
                "exchange full_forward_us and full_reverse_us of both thrusters"},
    Supposition{HeadingRule::kAsIs, ThrusterRule::kPortReversed, false, "port thruster",
                "the port thruster seems to be reversed",
                "exchange full_forward_us and full_reverse_us of the port thruster"},
    Supposition{HeadingRule::kAsIs, ThrusterRule::kStarboardReversed, false, "starboard thruster",
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

/// Headings less a supposed fault, unwrapped, at the times of the samples, which it borrows.
/// Requires: a heading.
class HeadingSeries {
 public:
  HeadingSeries(const std::vector<HeadingSample>& heading, HeadingRule rule) : heading_(heading) {
    psi_rad_.reserve(heading.size());
    for (const HeadingSample& sample : heading) {
      psi_rad_.push_back(UnwrappedBehind(psi_rad_, Undone(rule, sample.heading_deg)));
    }
  }

  double StartTime() const { return heading_.front().time_s; }
  double EndTime() const { return heading_.back().time_s; }
  bool Covers(double t) const { return StartTime() <= t && t <= EndTime(); }

  /// The time of the first sample that is later than `t`. Requires: there is one.
  double TimeAfter(double t) const { return heading_[LaterThan(t + kSameInstantS)].time_s; }

  /// Linear between the neighbours of `t`, held beyond the ends.
  double At(double t) const {
    if (t <= StartTime()) return psi_rad_.front();
    if (t >= EndTime()) return psi_rad_.back();
    const std::size_t right = LaterThan(t);
    const double since_s = heading_[right - 1].time_s;
    const double share = (t - since_s) / (heading_[right].time_s - since_s);
    return psi_rad_[right - 1] + share * (psi_rad_[right] - psi_rad_[right - 1]);
  }

 private:
  std::size_t LaterThan(double t) const {
    const auto later = std::ranges::upper_bound(heading_, t, {}, &HeadingSample::time_s);
    return static_cast<std::size_t>(later - heading_.begin());
  }

  const std::vector<HeadingSample>& heading_;
  std::vector<double> psi_rad_;
};

// ---- how well the motion follows the commands ---------------------------------------------------

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

class Motion {
 public:
  Motion(const std::vector<GnssFix>& gnss, const std::vector<HeadingSample>& heading,
         const std::vector<ThrusterSample>& thrusters, const Vehicle& vehicle)
      : heading_(heading),
        thrusters_(thrusters),
        vehicle_(vehicle),
        velocities_(VelocitiesOf(gnss)) {
    for (const Velocity& velocity : velocities_) moving_s_ += velocity.span_s;
    for (std::size_t i = 1; i < heading.size(); ++i) {
      const double span_s = heading[i].time_s - heading[i - 1].time_s;
      if (span_s <= kWidestChordS) turning_s_ += span_s;
    }
  }

  HeadingSeries Psi(HeadingRule rule) const { return {heading_, rule}; }

  Rests After(const Supposition& supposition) const {
    const HeadingSeries psi = Psi(supposition.heading);
    LaggedCommands at_yaw(thrusters_, vehicle_, kYawLagS);
    PositiveLine yaw;
    for (double t = psi.StartTime(); t + kYawStepS <= psi.EndTime(); t += kYawStepS) {
      const double next_s = psi.TimeAfter(t);
      if (next_s - t > kWidestChordS) {
        t = next_s - kYawStepS;
        continue;
      }
      const PropellerCommand command =
          Undone(supposition.thrusters, at_yaw.At(t + 0.5 * kYawStepS));
      yaw.Add(command.Difference(), (psi.At(t + kYawStepS) - psi.At(t)) / kYawStepS);
    }
    LaggedCommands at_speed = CommandsAtSpeed();
    PositiveLine velocity;
    PositiveLine across;
    for (Velocity v : velocities_) {
      if (!psi.Covers(v.time_s)) continue;
      if (supposition.positions_exchanged) std::swap(v.north_mps, v.east_mps);
      const double angle = psi.At(v.time_s);
      const PropellerCommand command = Undone(supposition.thrusters, at_speed.At(v.time_s));
      const double ahead_mps = v.north_mps * std::cos(angle) + v.east_mps * std::sin(angle);
      const double across_mps = v.east_mps * std::cos(angle) - v.north_mps * std::sin(angle);
      velocity.Add(command.Mean(), ahead_mps);
      velocity.AddUnexplained(across_mps);
      across.Add(command.Mean(), across_mps);
    }
    return {yaw.Rest(), velocity.Rest(), velocity.RestBeside(across)};
  }

  double EffectiveYawRates() const { return turning_s_ / (2.0 * kYawLagS); }
  double EffectiveVelocities() const { return moving_s_ / (2.0 * kSpeedLagS); }

  const std::vector<Velocity>& Velocities() const { return velocities_; }
  LaggedCommands CommandsAtSpeed() const { return {thrusters_, vehicle_, kSpeedLagS}; }

 private:
  const std::vector<HeadingSample>& heading_;
  const std::vector<ThrusterSample>& thrusters_;
  const Vehicle& vehicle_;
  std::vector<Velocity> velocities_;
  double moving_s_ = 0.0;
  double turning_s_ = 0.0;
};

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

Refusal Told(const Supposition& supposition, const Rests& as_is, const Rests& undone) {
  return {supposition.subject,
          std::string(supposition.reason) + ": the commands explain " + Percent(1.0 - undone.yaw) +
              " of the yaw rate and " + Percent(1.0 - undone.velocity) +
              " of the velocity without this fault, " + Percent(1.0 - as_is.yaw) + " and " +
              Percent(1.0 - as_is.velocity) + " of the input as it is",
          supposition.advice};
}

std::optional<Refusal> BestSupposition(const Motion& motion,
                                       const std::vector<HeadingSample>& heading) {
  if (std::min(motion.EffectiveYawRates(), motion.EffectiveVelocities()) < kFewestEffective) {
    return std::nullopt;
  }
  const Rests as_is = motion.After({});
  const bool could_be_radians = CouldBeRadians(heading);
  const Supposition* best = nullptr;
  Rests best_rests;
  double best_gain = kSureGain;
  for (const Supposition& supposition : kSuppositions) {
    if (supposition.heading == HeadingRule::kRadians && !could_be_radians) continue;
    const Rests rests = motion.After(supposition);
    // Yaw rate is one number, velocity two.
    const double gain = 0.5 * motion.EffectiveYawRates() * std::log(as_is.yaw / rests.yaw) +
                        motion.EffectiveVelocities() * std::log(as_is.velocity / rests.velocity);
    const bool explains = 1.0 - rests.yaw > kYawShare && 1.0 - rests.velocity > kVelocityShare;
    if (gain <= best_gain || !explains) continue;
    best = &supposition;
    best_rests = rests;
    best_gain = gain;
    // Headings that all lie within a turn of radians vary by no more than six degrees: turned by a
    // right angle they may explain a short recording as well.
    if (supposition.heading == HeadingRule::kRadians) break;
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

// ---- a constant angle ---------------------------------------------------------------------------

/// Course less heading while the boat drives ahead, beside its yaw rate.
struct Course {
  double psi_rad = 0.0;
  double drift_rad = 0.0;  ///< course - heading, [-pi, pi]
  double yaw_rate = 0.0;
};

std::vector<Course> CoursesAhead(const Motion& motion) {
  const HeadingSeries psi = motion.Psi(HeadingRule::kAsIs);
  LaggedCommands commands = motion.CommandsAtSpeed();
  std::vector<Course> courses;
  for (const Velocity& v : motion.Velocities()) {
    const bool is_ahead = std::hypot(v.north_mps, v.east_mps) > kSlowestMps &&
                          commands.At(v.time_s).Mean() > kAhead && psi.Covers(v.time_s);
    if (!is_ahead) continue;
    const double angle = psi.At(v.time_s);
    const double drift =
        std::remainder(std::atan2(v.east_mps, v.north_mps) - angle, 2.0 * std::numbers::pi);
    const double rate = psi.At(v.time_s + 0.5 * kChordS) - psi.At(v.time_s - 0.5 * kChordS);
    courses.push_back({angle, drift, rate / kChordS});
  }
  return courses;
}

template <class Angle>
std::complex<double> MeanDirection(const std::vector<Course>& courses, Angle angle) {
  std::complex<double> sum = 0.0;
  for (const Course& course : courses) sum += std::polar(1.0, angle(course));
  return sum / static_cast<double>(std::max<std::size_t>(1, courses.size()));
}

std::optional<Refusal> ConstantAngle(const Motion& motion) {
  const std::vector<Course> courses = CoursesAhead(motion);
  const double effective = static_cast<double>(courses.size()) * kChordS / (2.0 * kSpeedLagS);
  const auto headings = MeanDirection(courses, [](const Course& c) { return c.psi_rad; });
  const auto drift = MeanDirection(courses, [](const Course& c) { return c.drift_rad; });
  if (effective < kFewestEffective || std::abs(headings) > kSpreadHeadings ||
      std::abs(drift) < kConcentrated) {
    return std::nullopt;
  }
  // drift = angle + k r: a boat that turns slides outwards.
  double n = 0.0, r = 0.0, rr = 0.0, d = 0.0, dr = 0.0;
  const double centre = std::arg(drift);
  const auto about_centre = [&](const Course& c) {
    return std::remainder(c.drift_rad - centre, 2.0 * std::numbers::pi);
  };
  for (const Course& c : courses) {
    n += 1.0;
    r += c.yaw_rate;
    rr += c.yaw_rate * c.yaw_rate;
    d += about_centre(c);
    dr += about_centre(c) * c.yaw_rate;
  }
  const double determinant = n * rr - r * r;
  if (determinant <= 1e-9 * n * rr) return std::nullopt;
  const double offset = (rr * d - r * dr) / determinant;
  const double slope = (n * dr - r * d) / determinant;
  double square = 0.0;
  for (const Course& c : courses) {
    square += std::pow(about_centre(c) - offset - slope * c.yaw_rate, 2);
  }
  const double error = std::sqrt(square / n * (n * rr / determinant) / effective);
  const double angle_deg = (centre + offset) / kRadiansPerDegree;
  if (std::abs(angle_deg) < std::max(kConstantAngleDeg, kSureErrors * error / kRadiansPerDegree)) {
    return std::nullopt;
  }
  const std::string angle = FormatNumber(angle_deg, 0);
  return Refusal{"heading",
                 "headings seem to be magnetic, or the compass to be turned: over headings all "
                 "around the course keeps " +
                     angle + " ± " + FormatNumber(error / kRadiansPerDegree, 0) +
                     " degrees from the heading",
                 "add " + angle + " degrees to the headings, or the declination of the place"};
}

// ---- stuck channels -----------------------------------------------------------------------------

/// The longest run of equal values, as its first and last time.
struct Run {
  double start_s = 0.0;
  double end_s = 0.0;
};

template <class Sample, class Same>
Run LongestRun(const std::vector<Sample>& samples, Same same) {
  Run longest;
  std::size_t first = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!same(samples[first], samples[i])) first = i;
    if (samples[i].time_s - samples[first].time_s > longest.end_s - longest.start_s) {
      longest = {samples[first].time_s, samples[i].time_s};
    }
  }
  return longest;
}

Refusal Stuck(const char* channel, const Run& run, const std::string& although) {
  return {channel,
          std::string(channel) + " seems to be stuck: the same value from " +
              FormatNumber(run.start_s, 1) + " s to " + FormatNumber(run.end_s, 1) + " s, " +
              although,
          "repair the sensor or its link, or leave this part out"};
}

/// Whether the course turns while the boat moves.
bool CourseChanges(const Motion& motion, const Run& run) {
  std::complex<double> sum = 0.0;
  double travelled = 0.0;
  for (const Velocity& v : motion.Velocities()) {
    const double speed = std::hypot(v.north_mps, v.east_mps);
    if (v.time_s < run.start_s || v.time_s > run.end_s || speed < kSlowestMps) continue;
    sum += std::complex<double>(v.north_mps, v.east_mps) * v.span_s;
    travelled += speed * v.span_s;
  }
  return travelled > kStuckS * kSlowestMps && std::abs(sum) < 0.9 * travelled;
}

/// How long the thrusters turn the boat one way or the other.
double TurningS(const Motion& motion, const Run& run) {
  LaggedCommands commands = motion.CommandsAtSpeed();
  double turning_s = 0.0;
  for (double t = run.start_s; t < run.end_s; t += kYawStepS) {
    if (std::abs(commands.At(t).Difference()) > kTurning) turning_s += kYawStepS;
  }
  return turning_s;
}

std::optional<Refusal> StuckHeading(const std::vector<HeadingSample>& heading,
                                    const Motion& motion) {
  const Run run = LongestRun(
      heading, [](const auto& a, const auto& b) { return a.heading_deg == b.heading_deg; });
  if (run.end_s - run.start_s < kStuckS) return std::nullopt;
  if (CourseChanges(motion, run)) return Stuck("heading", run, "while the course changes");
  if (TurningS(motion, run) < kStuckS) return std::nullopt;
  return Stuck("heading", run, "while the thrusters turn the boat");
}

std::optional<Refusal> StuckPosition(const std::vector<GnssFix>& gnss, const Motion& motion) {
  const Run run = LongestRun(gnss, [](const auto& a, const auto& b) {
    return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
  });
  if (run.end_s - run.start_s < kStuckS) return std::nullopt;
  LaggedCommands commands = motion.CommandsAtSpeed();
  double pushed_s = 0.0;
  for (double t = run.start_s; t < run.end_s; t += kChordS) {
    if (std::abs(commands.At(t).Mean()) > kAhead) pushed_s += kChordS;
  }
  if (pushed_s < kStuckS) return std::nullopt;
  return Stuck("gnss", run, "while both thrusters push");
}

std::optional<Refusal> StuckThruster(const std::vector<ThrusterSample>& thrusters) {
  const auto moves = [&](double ThrusterSample::*pulse) {
    std::size_t count = 0;
    for (std::size_t i = 1; i < thrusters.size(); ++i) {
      count += thrusters[i].*pulse != thrusters[i - 1].*pulse ? 1 : 0;
    }
    return count;
  };
  const Run whole{thrusters.front().time_s, thrusters.back().time_s};
  const std::size_t port = moves(&ThrusterSample::port_us);
  const std::size_t starboard = moves(&ThrusterSample::starboard_us);
  if (port == 0 && starboard >= kFewestMoves) {
    return Stuck("port thruster", whole, "while the starboard command changes");
  }
  if (starboard == 0 && port >= kFewestMoves) {
    return Stuck("starboard thruster", whole, "while the port command changes");
  }
  if (port == 0 && starboard == 0 && whole.end_s - whole.start_s > kStuckS) {
    return Stuck("thrusters", whole, "so that nothing tells what they do");
  }
  return std::nullopt;
}

}  // namespace

std::vector<Refusal> MotionFaults(const std::vector<GnssFix>& gnss,
                                  const std::vector<HeadingSample>& heading,
                                  const std::vector<ThrusterSample>& thrusters,
                                  const Vehicle& vehicle) {
  if (gnss.size() < 2 || heading.size() < 2 || thrusters.size() < 2) return {};
  const Motion motion(gnss, heading, thrusters, vehicle);
  std::vector<Refusal> faults;
  // A stuck channel makes its motion seem wrong, so it comes first.
  auto stuck = StuckThruster(thrusters);
  if (!stuck) stuck = StuckHeading(heading, motion);
  if (!stuck) stuck = StuckPosition(gnss, motion);
  if (stuck) faults.push_back(*std::move(stuck));
  auto wrong = BestSupposition(motion, heading);
  if (!wrong) wrong = ConstantAngle(motion);
  if (wrong) faults.push_back(*std::move(wrong));
  return faults;
}

}  // namespace telltale
