#include "telltale/core/identification/experiment_design.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/stable_boat.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/simulation/manoeuvre_catalogue.hpp"
#include "telltale/core/simulation/sensors.hpp"

namespace telltale {
namespace {

using ::testing::HasSubstr;

Recording SimulatedThrough(const std::vector<Manoeuvre>& manoeuvres) {
  const auto commands = Schedule(manoeuvres, 0.0);
  double end_s = 0.0;
  for (const Manoeuvre& manoeuvre : manoeuvres) {
    for (const HeldCommand& held : manoeuvre) end_s += held.duration_s;
  }
  SensorOptions sensors;
  sensors.position_noise_m = 0.02;
  VesselState start;
  start.nu.u = 0.5;
  return Measure(Simulate(testing::StableBoat(), start, commands, end_s, 0.02),
                 testing::StableBoatVehicle(), sensors);
}

Manoeuvre FromCatalogue(std::string_view name) {
  const auto& catalogue = ManoeuvreCatalogue();
  const auto found = std::find_if(catalogue.begin(), catalogue.end(),
                                  [&](const auto& entry) { return entry.name == name; });
  return found->manoeuvre;
}

Identification IdentifiedFrom(const std::vector<Manoeuvre>& manoeuvres) {
  IdentifyOptions options;
  options.estimator = Estimator::kWeakIv;  // bounds of two estimators cannot be compared
  options.parametric_replicates = 0;
  const auto identification =
      Identify(SimulatedThrough(manoeuvres), testing::StableBoatVehicle(), options);
  EXPECT_TRUE(identification.has_value());
  return *identification;
}

const Coefficient& CoefficientOf(const Identification& identification, Equation equation,
                                 std::string_view regressor) {
  return *std::find_if(
      identification.coefficients.begin(), identification.coefficients.end(),
      [&](const auto& c) { return c.equation == equation && c.regressor == regressor; });
}

/// Turns ahead alone: nothing is known of thrust in reverse.
const std::vector<Manoeuvre>& TurnsAhead() {
  static const std::vector<Manoeuvre> turns = {FromCatalogue("zigzag at two speeds"),
                                               FromCatalogue("surge steps"),
                                               FromCatalogue("random steps ahead")};
  return turns;
}

TEST(Advice, AsksForReverseThrustWhereThereWasNone) {
  const Identification identification = IdentifiedFrom(TurnsAhead());
  ASSERT_FALSE(identification.advice.empty());
  const ManoeuvreAdvice& best = identification.advice.front();
  EXPECT_THAT(InWords(best), HasSubstr("from unknown to"));
  // Six coefficients of reverse thrust, two an equation, and every one of them gets bounds.
  std::size_t found = 0;
  for (const ExpectedBounds& expected : best.expected) {
    if (!expected.regressor.starts_with("r:")) continue;
    ++found;
    EXPECT_TRUE(std::isinf(expected.half_width));
    EXPECT_TRUE(std::isfinite(expected.expected_half_width)) << expected.regressor;
  }
  EXPECT_EQ(found, 6u);
  for (std::size_t i = 1; i < identification.advice.size(); ++i) {
    EXPECT_LE(identification.advice[i].expected_nats, identification.advice[i - 1].expected_nats);
  }
  // Ahead there is nothing to learn of it.
  for (const ManoeuvreAdvice& advice : identification.advice) {
    if (advice.manoeuvre != "surge steps") continue;
    for (const ExpectedBounds& expected : advice.expected) {
      if (expected.regressor.starts_with("r:")) {
        EXPECT_TRUE(std::isinf(expected.expected_half_width));
      }
    }
  }
}

/// The expected bounds come out when the advice is followed: simulated with the true model,
/// recorded, identified from old and new data. Bounds from a dozen or two clusters are themselves
/// known to a third, and simulation knew the boat from the first recording alone.
TEST(Advice, KeepsItsPromiseWhenFollowed) {
  const Identification before = IdentifiedFrom(TurnsAhead());
  ASSERT_FALSE(before.advice.empty());
  const ManoeuvreAdvice& best = before.advice.front();
  std::vector<Manoeuvre> longer = TurnsAhead();
  longer.push_back(FromCatalogue(best.manoeuvre));
  const Identification after = IdentifiedFrom(longer);
  double log_ratio = 0.0;
  for (const ExpectedBounds& expected : best.expected) {
    const Coefficient& c = CoefficientOf(after, expected.equation, expected.regressor);
    const double got = 0.5 * (c.interval.upper - c.interval.lower);
    EXPECT_LT(got, expected.half_width);
    log_ratio +=
        std::log(got / expected.expected_half_width) / static_cast<double>(best.expected.size());
  }
  EXPECT_NEAR(log_ratio, 0.0, std::log(2.0));
}

TEST(Advice, HasNothingToSayWhereAllIsKnown) {
  std::vector<Manoeuvre> everything;
  for (const CatalogueManoeuvre& entry : ManoeuvreCatalogue()) {
    everything.push_back(entry.manoeuvre);
  }
  const Identification identification = IdentifiedFrom(everything);
  EXPECT_TRUE(identification.advice.empty());
  ASSERT_EQ(identification.excitation.size(), 3u);
  for (const ExcitationSummary& summary : identification.excitation) {
    EXPECT_LT(summary.condition, 100.0);
    EXPECT_GT(summary.effective_rows, 0.0);
    EXPECT_LE(summary.effective_rows, static_cast<double>(summary.rows));
  }
}

/// Data in which two coefficients move together: the refusal names them, and what would part them.
TEST(Advice, SeparatesCollinearCoefficients) {
  const Identification identification =
      IdentifiedFrom({FromCatalogue("zigzag"), FromCatalogue("zigzag"), FromCatalogue("spins")});
  const auto named = std::find_if(
      identification.refusals.begin(), identification.refusals.end(),
      [](const Refusal& r) { return r.reason.find("are collinear") != std::string::npos; });
  ASSERT_NE(named, identification.refusals.end());
  EXPECT_THAT(named->advice, HasSubstr(" for 120 s would shrink "));
  EXPECT_FALSE(identification.advice.empty());
}

/// Straight runs tell nothing of sway and yaw: there is no boat to simulate, so words remain.
TEST(Advice, KeepsToWordsWhereThereIsNoBoatToSimulate) {
  const Identification identification =
      IdentifiedFrom({FromCatalogue("surge steps"), FromCatalogue("staircase")});
  EXPECT_FALSE(identification.Has(Equation::kYaw));
  EXPECT_TRUE(identification.advice.empty());
  for (const Refusal& refusal : identification.refusals) EXPECT_FALSE(refusal.advice.empty());
}

TEST(Advice, ComesWithTheOneStepEstimatorToo) {
  IdentifyOptions options = IdentifyOptions::OneStep();
  options.bootstrap_replicates = 0;
  const auto identification =
      Identify(SimulatedThrough(TurnsAhead()), testing::StableBoatVehicle(), options);
  ASSERT_TRUE(identification.has_value());
  EXPECT_FALSE(identification->advice.empty());
  ASSERT_EQ(identification->excitation.size(), 3u);
  EXPECT_GT(identification->excitation[0].effective_rows, 0.0);
  options.regression.structure = Structure::kFirstOrderDynamic;
  const auto lagging =
      Identify(SimulatedThrough(TurnsAhead()), testing::StableBoatVehicle(), options);
  ASSERT_TRUE(lagging.has_value());
  EXPECT_FALSE(lagging->advice.empty());
  EXPECT_EQ(lagging->excitation[1].rows, identification->excitation[1].rows);
}

}  // namespace
}  // namespace telltale
