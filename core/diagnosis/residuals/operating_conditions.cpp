#include "telltale/core/diagnosis/residuals/operating_conditions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/vessel/compass.hpp"

namespace telltale {
namespace {

constexpr auto& kSpeedEdges = kDiagnosis.localisation.speed_edges_m_s;

std::string SpeedName(std::size_t bin) {
  const auto text = [&](double value) {
    return std::to_string(static_cast<int>(value)) +
           (value - std::floor(value) > 0.0 ? ".5" : ".0");
  };
  if (bin == 0) return "below " + text(kSpeedEdges.front()) + " m/s";
  if (bin == kSpeedEdges.size()) return "above " + text(kSpeedEdges.back()) + " m/s";
  return text(kSpeedEdges[bin - 1]) + " to " + text(kSpeedEdges[bin]) + " m/s";
}

}  // namespace

std::size_t SpeedBin(double speed_m_s) {
  return static_cast<std::size_t>(
      std::upper_bound(kSpeedEdges.begin(), kSpeedEdges.end(), speed_m_s) - kSpeedEdges.begin());
}

std::vector<OperatingCondition> OperatingConditions() {
  std::vector<OperatingCondition> conditions;
  conditions.push_back({std::nullopt, "", [](const AccelerationResidual&) { return true; }});
  for (const PropellerRegion region : kPropellerRegions) {
    conditions.push_back({region, "", [region](const AccelerationResidual& residual) {
                            return residual.region == region;
                          }});
    for (std::size_t bin = 0; bin <= kSpeedEdges.size(); ++bin) {
      conditions.push_back(
          {region, SpeedName(bin), [region, bin](const AccelerationResidual& residual) {
             return residual.region == region && residual.speed == bin;
           }});
    }
  }
  for (std::size_t bin = 0; bin <= kSpeedEdges.size(); ++bin) {
    conditions.push_back(
        {std::nullopt, SpeedName(bin),
         [bin](const AccelerationResidual& residual) { return residual.speed == bin; }});
  }
  for (std::size_t point = 0; point < kCompassPoints.size(); ++point) {
    conditions.push_back(
        {std::nullopt, "heading " + std::string(kCompassPoints[point]),
         [point](const AccelerationResidual& residual) { return residual.octant == point; }});
  }
  constexpr std::array<std::string_view, 3> kThirds = {"first third", "middle third", "last third"};
  for (std::size_t third = 0; third < kThirds.size(); ++third) {
    conditions.push_back(
        {std::nullopt, std::string(kThirds[third]),
         [third](const AccelerationResidual& residual) { return residual.third == third; }});
  }
  conditions.push_back({std::nullopt, "after a step",
                        [](const AccelerationResidual& residual) { return residual.after_step; }});
  conditions.push_back({std::nullopt, "steady commands",
                        [](const AccelerationResidual& residual) { return !residual.after_step; }});
  return conditions;
}

}  // namespace telltale
