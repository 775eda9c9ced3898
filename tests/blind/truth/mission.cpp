#include "mission.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "degree.hpp"

namespace blind::truth {
namespace {

Command MeanAndDifference(double mean, double half_difference) {
  return {std::clamp(mean + half_difference, -1.0, 1.0),
          std::clamp(mean - half_difference, -1.0, 1.0)};
}

/// Keeps a course with a base throttle by proportional and rate feedback.
Command KeepCourse(double course, double throttle, const State& state) {
  const double error = std::remainder(course - state.heading_rad, 2.0 * std::numbers::pi);
  const double turn = std::clamp(0.5 * error - 0.35 * state.yaw_radps, -0.4, 0.4);
  return MeanAndDifference(throttle, turn);
}

double ForwardCommand(RandomStream& rng) {
  return rng.Uniform(0.12, 0.85);
}
double ReverseCommand(RandomStream& rng) {
  return rng.Uniform(-0.7, -0.12);
}

/// Forward together mostly, against each other often, astern together seldom and gently.
Command RandomCommand(RandomStream& rng) {
  const double threshold = rng.Uniform(0.0, 1.0);
  if (threshold < 0.60) return {ForwardCommand(rng), ForwardCommand(rng)};
  if (threshold < 0.77) return {ForwardCommand(rng), ReverseCommand(rng)};
  if (threshold < 0.94) return {ReverseCommand(rng), ForwardCommand(rng)};
  return {0.6 * ReverseCommand(rng), 0.6 * ReverseCommand(rng)};
}

struct SetPoint {
  double until_s;
  Command command;
};

std::vector<SetPoint> RandomSetPoints(double duration_s, double shortest_s, double longest_s,
                                      RandomStream& rng) {
  std::vector<SetPoint> points;
  for (double end = 0.0; end < duration_s;) {
    end += rng.Uniform(shortest_s, longest_s);
    points.push_back({end, RandomCommand(rng)});
  }
  return points;
}

std::size_t PointAt(const std::vector<SetPoint>& points, double since_s) {
  std::size_t at = 0;
  while (at + 1 < points.size() && since_s >= points[at].until_s) ++at;
  return at;
}

Manoeuvre Steps(double duration_s, double shortest_s, double longest_s, RandomStream& rng) {
  auto points = RandomSetPoints(duration_s, shortest_s, longest_s, rng);
  return {duration_s, [points = std::move(points)](double since, const State&) {
            return points[PointAt(points, since)].command;
          }};
}

Manoeuvre RandomSteps(RandomStream& rng) {
  return Steps(rng.Uniform(40, 70), 3.0, 8.0, rng);
}
Manoeuvre FastSteps(RandomStream& rng) {
  return Steps(rng.Uniform(20, 35), 0.6, 1.6, rng);
}

/// From set point to set point in straight lines.
Manoeuvre Ramps(RandomStream& rng) {
  const double duration = rng.Uniform(40, 70);
  auto points = RandomSetPoints(duration, 2.5, 6.0, rng);
  return {duration, [points = std::move(points)](double since, const State&) {
            const std::size_t at = PointAt(points, since);
            const double start = at == 0 ? 0.0 : points[at - 1].until_s;
            const Command from = at == 0 ? Command{} : points[at - 1].command;
            const Command to = points[at].command;
            const double share = std::min(1.0, (since - start) / (points[at].until_s - start));
            return Command{from.port + share * (to.port - from.port),
                           from.starboard + share * (to.starboard - from.starboard)};
          }};
}

Manoeuvre TimedZigzag(RandomStream& rng) {
  const double mean = rng.Uniform(0.35, 0.65), turn = rng.Uniform(0.12, 0.3);
  const double half_period = rng.Uniform(3.0, 7.0);
  return {rng.Uniform(35, 55), [=](double since, const State&) {
            const bool to_starboard = std::fmod(since, 2.0 * half_period) < half_period;
            return MeanAndDifference(mean, to_starboard ? turn : -turn);
          }};
}

/// The other way each time the heading has left its start by the same angle.
Manoeuvre HeadingZigzag(RandomStream& rng) {
  struct Memory {
    bool started = false;
    double start = 0.0;
    double side = 1.0;
  };
  auto memory = std::make_shared<Memory>();
  const double mean = rng.Uniform(0.3, 0.7), turn = rng.Uniform(0.15, 0.35);
  const double angle = rng.Uniform(15.0, 35.0) * kDegree;
  return {rng.Uniform(35, 60), [=](double, const State& state) {
            if (!std::exchange(memory->started, true)) memory->start = state.heading_rad;
            if (memory->side * (state.heading_rad - memory->start) > angle) memory->side *= -1.0;
            return MeanAndDifference(mean, memory->side * turn);
          }};
}

Manoeuvre Staircase(RandomStream& rng) {
  const double tread = rng.Uniform(4.0, 7.0), riser = rng.Uniform(0.10, 0.16);
  const double turn = rng.Uniform(-0.05, 0.05);
  return {10.0 * tread, [=](double since, const State&) {
            const double stair = std::floor(since / tread);
            return MeanAndDifference(riser * (stair < 5.0 ? stair + 1.0 : 10.0 - stair), turn);
          }};
}

Manoeuvre Circle(RandomStream& rng) {
  const double mean = rng.Uniform(0.3, 0.6), turn = rng.Sign() * rng.Uniform(0.1, 0.35);
  return {rng.Uniform(20, 35), [=](double, const State&) { return MeanAndDifference(mean, turn); }};
}

Manoeuvre FigureOfEight(RandomStream& rng) {
  const double mean = rng.Uniform(0.35, 0.6), turn = rng.Sign() * rng.Uniform(0.15, 0.35);
  const double half = rng.Uniform(12.0, 20.0);
  return {2.0 * half, [=](double since, const State&) {
            return MeanAndDifference(mean, since < half ? turn : -turn);
          }};
}

Manoeuvre Legs(RandomStream& rng) {
  const double first = rng.Angle(), turn = rng.Sign() * rng.Uniform(40, 100) * kDegree;
  const double throttle = rng.Uniform(0.3, 0.7), leg = rng.Uniform(12.0, 18.0);
  return {4.0 * leg, [=](double since, const State& state) {
            return KeepCourse(first + turn * std::floor(since / leg), throttle, state);
          }};
}

/// Four legs at right angles, each at a throttle of its own.
Manoeuvre Box(RandomStream& rng) {
  const double first = rng.Angle(), side = rng.Sign();
  std::vector<double> throttles;
  for (int leg = 0; leg < 4; ++leg) throttles.push_back(rng.Uniform(0.25, 0.8));
  const double leg_s = rng.Uniform(10.0, 16.0);
  return {4.0 * leg_s, [=, throttles = std::move(throttles)](double since, const State& state) {
            const auto leg = std::min<std::size_t>(3, static_cast<std::size_t>(since / leg_s));
            const double course = first + side * 90.0 * kDegree * static_cast<double>(leg);
            return KeepCourse(course, throttles[leg], state);
          }};
}

Manoeuvre Spin(RandomStream& rng) {
  const double side = rng.Sign(), ahead = rng.Uniform(0.25, 0.6), astern = rng.Uniform(0.25, 0.6);
  return {rng.Uniform(8, 14), [=](double since, const State&) {
            if (since > 11.0) return Command{};
            return side > 0.0 ? Command{ahead, -astern} : Command{-astern, ahead};
          }};
}

/// A slowly growing difference, first one way, then the other.
Manoeuvre Spiral(RandomStream& rng) {
  const double mean = rng.Uniform(0.3, 0.55), most = rng.Sign() * rng.Uniform(0.3, 0.6);
  const double half = rng.Uniform(18.0, 26.0);
  return {2.0 * half, [=](double since, const State&) {
            return MeanAndDifference(mean, most * std::sin(std::numbers::pi * since / half));
          }};
}

/// Sines of rising frequency in the mean and, by another, in the difference.
Manoeuvre Sweep(RandomStream& rng) {
  const double duration = rng.Uniform(40, 60), mean = rng.Uniform(0.35, 0.55);
  const double surge = rng.Uniform(0.1, 0.25), turn = rng.Uniform(0.1, 0.25);
  const double slow = 2.0 * std::numbers::pi / rng.Uniform(12.0, 18.0);
  const double fast = 2.0 * std::numbers::pi / rng.Uniform(2.5, 4.0);
  return {duration, [=](double since, const State&) {
            const double phase = slow * since + 0.5 * (fast - slow) * since * since / duration;
            return MeanAndDifference(mean + surge * std::sin(0.7 * phase), turn * std::sin(phase));
          }};
}

Manoeuvre Coast(RandomStream& rng) {
  const double throttle = rng.Uniform(0.45, 0.8), turn = rng.Uniform(-0.15, 0.15);
  return {rng.Uniform(14, 20), [=](double since, const State&) {
            return since < 6.0 ? MeanAndDifference(throttle, turn) : Command{};
          }};
}

/// Full of way, then astern until it is off.
Manoeuvre Braking(RandomStream& rng) {
  const double ahead = rng.Uniform(0.5, 0.8), astern = rng.Uniform(0.3, 0.6);
  auto stopped = std::make_shared<bool>(false);
  return {rng.Uniform(12, 16), [=](double since, const State& state) {
            if (since < 7.0) return MeanAndDifference(ahead, 0.0);
            if (state.surge_mps < 0.1) *stopped = true;
            return *stopped ? Command{} : MeanAndDifference(-astern, 0.0);
          }};
}

/// Short pushes of one or both thrusters out of rest.
Manoeuvre Bursts(RandomStream& rng) {
  const double duration = rng.Uniform(24, 36);
  std::vector<Command> pushes;
  for (double at = 0.0; at < duration; at += 4.0) pushes.push_back(RandomCommand(rng));
  return {duration, [pushes = std::move(pushes)](double since, const State&) {
            const auto push = std::min(pushes.size() - 1, static_cast<std::size_t>(since / 4.0));
            return std::fmod(since, 4.0) < 1.2 ? pushes[push] : Command{};
          }};
}

using Drawing = Manoeuvre (*)(RandomStream&);

std::vector<Drawing> MixOf(Set set) {
  if (set == Set::kDevelopment) {
    return {RandomSteps, RandomSteps, TimedZigzag, Staircase, Circle,
            Legs,        Spin,        Spin,        Coast,     FastSteps};
  }
  return {Ramps, Ramps, HeadingZigzag, FigureOfEight, Box, Spin, Spiral, Sweep, Braking, Bursts};
}

}  // namespace

Command Mission::At(double time_s, const State& state) {
  while (current_ < manoeuvres_.size() && time_s - start_s_ >= manoeuvres_[current_].duration_s) {
    start_s_ += manoeuvres_[current_].duration_s;
    ++current_;
  }
  if (current_ == manoeuvres_.size()) return {};
  return manoeuvres_[current_].steer(time_s - start_s_, state);
}

Mission DrawnMission(Set set, double duration_s, RandomStream rng) {
  std::vector<Manoeuvre> manoeuvres;
  double drawn_s = 0.0;
  while (drawn_s < duration_s) {
    std::vector<Drawing> mix = MixOf(set);
    rng.Shuffle(mix);
    for (const Drawing draw : mix) {
      manoeuvres.push_back(draw(rng));
      drawn_s += manoeuvres.back().duration_s;
    }
  }
  return Mission(std::move(manoeuvres));
}

}  // namespace blind::truth
