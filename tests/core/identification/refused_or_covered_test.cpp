#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/sensors.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr double kEachKindS = 90.0;
constexpr std::size_t kKinds = 5;
constexpr std::size_t kSubsets = (1u << kKinds) - 1;

const std::array<std::string, kKinds> kKindNames = {"surge steps", "circles", "zigzag", "spin",
                                                    "coast"};

Manoeuvre OfKind(std::size_t kind) {
  switch (kind) {
    case 0:
      return Repeated(Joined({SurgeSteps(0.2, 0.9, 2, 4.0), SurgeSteps(0.4, 0.7, 2, 3.0)}),
                      kEachKindS);
    case 1:
      return Joined({Circle(0.35, 0.3, kEachKindS / 4), Circle(0.35, -0.3, kEachKindS / 4),
                     Circle(0.75, 0.5, kEachKindS / 4), Circle(0.75, -0.5, kEachKindS / 4)});
    case 2:
      return Repeated(Joined({Zigzag(0.4, 0.5, 3, 4.0), Zigzag(0.7, 0.6, 3, 3.0)}), kEachKindS);
    case 3: return Repeated(Joined({Spins(0.3, 6.0), Spins(0.6, 6.0)}), kEachKindS);
    default:
      return Repeated(
          Joined({SurgeSteps(0.8, 0.8, 1, 3.0), Coast(6.0), Zigzag(0.5, 0.6, 1, 3.0), Coast(6.0)}),
          kEachKindS);
  }
}

std::string NameOfSubset(std::size_t subset) {
  std::string name;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    if ((subset >> kind & 1u) != 0) name += (name.empty() ? "" : ", ") + kKindNames[kind];
  }
  return name;
}

Recording SimulatedSubset(std::size_t subset) {
  std::vector<Manoeuvre> manoeuvres;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    if ((subset >> kind & 1u) != 0) manoeuvres.push_back(OfKind(kind));
  }
  SensorOptions sensors;
  sensors.position_noise_m = 0.02;
  sensors.seed = subset;
  const double end_s = kEachKindS * static_cast<double>(manoeuvres.size());
  return Measure(Simulate(testing::StableBoat(), {}, Schedule(manoeuvres, 0.0), end_s, 0.02),
                 testing::StableBoatVehicle(), sensors);
}

std::vector<std::optional<Identification>> IdentifyAllSubsets(const IdentifyOptions& options) {
  std::vector<std::optional<Identification>> all(kSubsets);
  ForEachIndex(kSubsets, 2, [&](std::size_t i) {
    auto identification = Identify(SimulatedSubset(i + 1), testing::StableBoatVehicle(), options);
    if (identification) all[i] = *std::move(identification);
  });
  return all;
}

/// The default estimator with as few replicates as its correction takes.
IdentifyOptions WithFewReplicates() {
  IdentifyOptions options;
  options.parametric_replicates = 8;
  options.advise = false;
  return options;
}

double TrueValueOf(const Coefficient& coefficient) {
  const auto regressors = Regressors(coefficient.equation, Parameterization::kPropeller);
  const auto found = std::find_if(regressors.begin(), regressors.end(), [&](const Regressor& r) {
    return r.name == coefficient.regressor;
  });
  return testing::StableBoat().theta[IndexOf(coefficient.equation)][found - regressors.begin()];
}

double HalfWidthOf(const Coefficient& coefficient) {
  return 0.5 * (coefficient.interval.upper - coefficient.interval.lower);
}

/// How many half widths of an interval an honest estimate stays within, in all of `comparisons`
/// together but for one time in a hundred: Student's t with the degrees of freedom that clusters of
/// eight seconds leave.
double UsableMultiple(const Identification& identification, std::size_t comparisons) {
  const double clusters = (identification.window.end_s - identification.window.start_s) / 8.0;
  const double degrees_of_freedom = std::floor(clusters) - 1.0;
  const double tail = 0.5 * 0.01 / static_cast<double>(comparisons);
  return -StudentQuantile(degrees_of_freedom, tail) / StudentQuantile(degrees_of_freedom, 0.975);
}

bool WasRefused(const Identification* identification, const Coefficient& coefficient) {
  if (identification == nullptr || !identification->Has(coefficient.equation)) return true;
  for (const Coefficient& c : identification->coefficients) {
    if (c.equation != coefficient.equation || c.regressor != coefficient.regressor) continue;
    return c.status != CoefficientStatus::kEstimated;
  }
  return true;
}

TEST(RefuseOrRight, EveryAnswerOfEverySubsetOfManoeuvresHoldsTheTruth) {
  const auto all = IdentifyAllSubsets(WithFewReplicates());
  std::size_t comparisons = 0;
  for (const auto& identification : all) {
    if (!identification) continue;
    for (const Coefficient& c : identification->coefficients) {
      comparisons += c.status == CoefficientStatus::kEstimated ? 1 : 0;
    }
  }
  // Neither all answered nor all refused, or this says nothing.
  EXPECT_GT(comparisons, kSubsets * 35 / 4);
  EXPECT_LT(comparisons, kSubsets * 35);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) continue;
    const double multiple = UsableMultiple(*all[i], comparisons);
    for (const Coefficient& c : all[i]->coefficients) {
      if (c.status != CoefficientStatus::kEstimated) continue;
      EXPECT_LE(std::abs(c.estimate - TrueValueOf(c)), multiple * HalfWidthOf(c))
          << Name(c.equation) << ' ' << c.regressor << " of " << NameOfSubset(i + 1) << ": "
          << c.estimate << " for " << TrueValueOf(c) << ", +-" << HalfWidthOf(c)
          << ", sound multiple " << multiple;
    }
  }
}

/// Who lowers every limit gets numbers for what was refused, and some of them are worse than none.
TEST(RefuseOrRight, AnswersForcedOutOfRefusedDataAreBad) {
  const auto all = IdentifyAllSubsets(WithFewReplicates());
  IdentifyOptions forcing = WithFewReplicates();
  forcing.excitation = {2.0, 0.0, 0.0, 0.0, 1, 1e6};
  const auto forced = IdentifyAllSubsets(forcing);
  std::size_t worse_than_zero = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!forced[i]) continue;
    for (const Coefficient& c : forced[i]->coefficients) {
      if (c.status != CoefficientStatus::kEstimated) continue;
      if (!WasRefused(all[i] ? &*all[i] : nullptr, c)) continue;
      worse_than_zero += std::abs(c.estimate - TrueValueOf(c)) > std::abs(TrueValueOf(c)) ? 1 : 0;
    }
  }
  EXPECT_GT(worse_than_zero, 0u);
}

}  // namespace
}  // namespace telltale
