#include "telltale/core/data/check/stuck_channels.hpp"

#include <cmath>
#include <complex>
#include <string>

#include "telltale/core/base/format_number.hpp"

namespace telltale {
namespace {

constexpr double kStuckS = 10.0;
constexpr double kStepS = 0.5;
constexpr double kTurning = 0.15;        // difference of commands that turns any boat
constexpr std::size_t kFewestMoves = 3;  // of the other thruster, for one that never moves

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
bool CourseChanges(const RecordedMotion& motion, const Run& run) {
  std::complex<double> sum = 0.0;
  double travelled = 0.0;
  for (const Velocity& v : motion.Velocities()) {
    const double speed = std::hypot(v.north_mps, v.east_mps);
    if (v.time_s < run.start_s || v.time_s > run.end_s || speed < RecordedMotion::kSlowest)
      continue;
    sum += std::complex<double>(v.north_mps, v.east_mps) * v.span_s;
    travelled += speed * v.span_s;
  }
  return travelled > kStuckS * RecordedMotion::kSlowest && std::abs(sum) < 0.9 * travelled;
}

/// How long the thrusters turn the boat one way or the other.
double TurningS(const RecordedMotion& motion, const Run& run) {
  LaggedCommands commands = motion.CommandsAtSpeed();
  double turning_s = 0.0;
  for (double t = run.start_s; t < run.end_s; t += kStepS) {
    if (std::abs(commands.At(t).Difference()) > kTurning) turning_s += kStepS;
  }
  return turning_s;
}

std::optional<Refusal> StuckHeading(const std::vector<HeadingSample>& heading,
                                    const RecordedMotion& motion) {
  const Run run = LongestRun(
      heading, [](const auto& a, const auto& b) { return a.heading_deg == b.heading_deg; });
  if (run.end_s - run.start_s < kStuckS) return std::nullopt;
  if (CourseChanges(motion, run)) return Stuck("heading", run, "while the course changes");
  if (TurningS(motion, run) < kStuckS) return std::nullopt;
  return Stuck("heading", run, "while the thrusters turn the boat");
}

std::optional<Refusal> StuckPosition(const std::vector<GnssFix>& gnss,
                                     const RecordedMotion& motion) {
  const Run run = LongestRun(gnss, [](const auto& a, const auto& b) {
    return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
  });
  if (run.end_s - run.start_s < kStuckS) return std::nullopt;
  LaggedCommands commands = motion.CommandsAtSpeed();
  double pushed_s = 0.0;
  for (double t = run.start_s; t < run.end_s; t += RecordedMotion::kChordS) {
    if (std::abs(commands.At(t).Mean()) > RecordedMotion::kAhead)
      pushed_s += RecordedMotion::kChordS;
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

std::optional<Refusal> StuckChannel(const std::vector<GnssFix>& gnss,
                                    const std::vector<HeadingSample>& heading,
                                    const std::vector<ThrusterSample>& thrusters,
                                    const RecordedMotion& motion) {
  auto stuck = StuckThruster(thrusters);
  if (!stuck) stuck = StuckHeading(heading, motion);
  if (!stuck) stuck = StuckPosition(gnss, motion);
  return stuck;
}

}  // namespace telltale
