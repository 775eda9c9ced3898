#include "telltale/core/paper/paper_mission.hpp"

#include "telltale/core/base/random.hpp"
#include "telltale/core/paper/yellowfish.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"

namespace telltale {
namespace {

constexpr double kPointPeriodS = 0.2;
constexpr double kPauseS = 10.0;
constexpr double kStepS = 0.02;

/// The manoeuvre of a segment: eight kinds take turns, and the seed varies levels and holds.
Manoeuvre SegmentOfKind(std::size_t kind, double duration_s, std::uint64_t seed) {
  RandomEngine engine(seed);
  const auto between = [&](double low, double high) {
    const double share = static_cast<double>(engine() >> 11) * 0x1.0p-53;
    return low + (high - low) * share;
  };
  const auto random = [&](const CommandRange& range, double shortest_s, double longest_s) {
    return RandomSteps(range, shortest_s, longest_s, duration_s, engine());
  };
  const double side = between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
  switch (kind % 8) {
    case 0: return {{{between(0.4, 1.0), between(0.4, 1.0)}, duration_s}};
    case 1: return random({{0.1, 0.1}, {1.0, 1.0}}, 2.0, 5.0);
    case 2: return Zigzag(between(0.4, 0.8), side * between(0.3, 0.7), 20, between(2.0, 5.0));
    case 3: return Circle(between(0.4, 0.7), side * between(0.2, 0.6), duration_s);
    case 4: return random({{0.05, -0.6}, {0.9, -0.05}}, 1.0, 4.0);
    case 5: return random({{-0.6, 0.05}, {-0.05, 0.9}}, 1.0, 4.0);
    case 6: return random({{0.1, -0.5}, {0.8, -0.05}}, 2.0, 6.0);
    default: return random({{-0.5, 0.1}, {-0.05, 0.8}}, 2.0, 6.0);
  }
}

/// Segments have equal numbers of points; the first ones take the remainder.
std::size_t PointsOf(std::size_t segment) {
  return kPaperPoints / kPaperSegments + (segment < kPaperPoints % kPaperSegments ? 1 : 0);
}

VesselState SlowAhead(const VesselModel& model, const TimedCommand& first) {
  return {{}, {0.5, 0.0, 0.0}, model.SteadyThrust(first.delta)};
}

void Append(const Recording& part, double offset_s, Recording& whole) {
  const auto shifted = [&](auto samples, auto& into) {
    for (auto& sample : samples) {
      sample.time_s += offset_s;
      into.push_back(sample);
    }
  };
  shifted(part.gnss, whole.gnss);
  shifted(part.heading, whole.heading);
  shifted(part.thrusters, whole.thrusters);
}

}  // namespace

std::vector<PaperSegment> PaperMission(std::uint64_t seed) {
  std::vector<PaperSegment> mission;
  for (std::size_t segment = 0; segment < kPaperSegments; ++segment) {
    const std::size_t points = PointsOf(segment);
    const double duration_s = static_cast<double>(points) * kPointPeriodS;
    const auto own_seed = RandomEngine::Stream(seed, segment)();
    mission.push_back({Schedule({SegmentOfKind(segment, duration_s, own_seed)}, 0.0), points});
  }
  return mission;
}

Recording RecordPaperMission(const VesselModel& model, const SensorOptions& sensors,
                             std::uint64_t seed) {
  Recording whole;
  double offset_s = 0.0;
  std::uint64_t index = 0;
  for (const PaperSegment& segment : PaperMission(seed)) {
    const double end_s = static_cast<double>(segment.points - 1) * kPointPeriodS;
    const auto track = Simulate(model, SlowAhead(model, segment.commands.front()), segment.commands,
                                end_s, kStepS);
    SensorOptions own = sensors;
    own.seed = RandomEngine::Stream(sensors.seed, index++)();
    Append(Measure(track, YellowfishVehicle(), own), offset_s, whole);
    offset_s += end_s + kPauseS;
  }
  return whole;
}

}  // namespace telltale
