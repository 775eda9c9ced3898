#include "telltale/core/data/held_commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "telltale/core/data/time_series.hpp"

namespace telltale {
namespace {

// Antiderivative of 1 - |s| on [-1, 1].
double TriangleArea(double s) {
  return s - 0.5 * s * std::abs(s);
}

void Accumulate(PropellerCommand& sum, const PropellerCommand& command, double weight) {
  sum.port += weight * command.port;
  sum.starboard += weight * command.starboard;
}

}  // namespace

HeldCommands::HeldCommands(std::span<const ThrusterSample> samples, const Vehicle& vehicle) {
  Require(!samples.empty(), "at least one thruster sample");
  times_s_.reserve(samples.size());
  commands_.reserve(samples.size());
  for (const ThrusterSample& sample : samples) {
    times_s_.push_back(sample.time_s);
    commands_.push_back(vehicle.Normalise(sample.port_us, sample.starboard_us));
  }
}

std::size_t HeldCommands::IndexAt(double t) const {
  const auto later = std::upper_bound(times_s_.begin(), times_s_.end(), t + kSameInstantS);
  return later == times_s_.begin() ? 0 : static_cast<std::size_t>(later - times_s_.begin()) - 1;
}

PropellerCommand HeldCommands::At(double t) const {
  return commands_[IndexAt(t)];
}

PropellerCommand HeldCommands::Mean(double from, double to) const {
  PropellerCommand sum;
  ForEachPiece(from, to, [&](const PropellerCommand& command, double start, double end) {
    Accumulate(sum, command, (end - start) / (to - from));
  });
  return sum;
}

PropellerCommand HeldCommands::TriangularMean(double t, double half_width) const {
  PropellerCommand sum;
  ForEachPiece(t - half_width, t + half_width,
               [&](const PropellerCommand& command, double start, double end) {
                 const double weight =
                     TriangleArea((end - t) / half_width) - TriangleArea((start - t) / half_width);
                 Accumulate(sum, command, weight);
               });
  return sum;
}

PropellerRegion HeldCommands::MajorityRegion(double from, double to) const {
  std::array<double, kPropellerRegions.size()> time_in{};
  ForEachPiece(from, to, [&](const PropellerCommand& command, double start, double end) {
    time_in[static_cast<std::size_t>(RegionOf(command))] += end - start;
  });
  const double longest = *std::max_element(time_in.begin(), time_in.end());
  const PropellerRegion first = RegionOf(At(from));
  if (time_in[static_cast<std::size_t>(first)] >= longest - kSameInstantS) return first;
  const auto winner = std::max_element(time_in.begin(), time_in.end()) - time_in.begin();
  return kPropellerRegions[static_cast<std::size_t>(winner)];
}

}  // namespace telltale
