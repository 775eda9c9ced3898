#include "fit/unknown_odds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "support/run_command.hpp"
#include "support/temporary_folder.hpp"

namespace blind::fit {
namespace {

using score::Cause;
using score::EffectSet;
using score::Scored;

Cause Named(const EffectSet& effects, double probability) {
  return {.effects = effects,
          .probability = probability,
          .indistinguishable = {},
          .indistinguishable_sets = {},
          .directions = {}};
}

Scored Case(const std::string& kind, const EffectSet& truth, const std::vector<Cause>& causes) {
  Scored scored{.label = {kind, truth, {}}, .report = {}, .left_out = {}};
  scored.report.verdict = "UNKNOWN_CAUSE";
  scored.report.causes = causes;
  scored.report.unknown_regressors = {{"misfit", 0.5}};
  return scored;
}

TEST(ObservationsOf, AskWhetherTheLikeliestNamedCauseIsTheTrueOne) {
  const auto seen = ObservationsOf({
      Case("single", {"payload"}, {Named({"unknown"}, 0.9), Named({"payload"}, 0.1)}),
      Case("single", {"payload"}, {Named({"wind"}, 0.9), Named({"unknown"}, 0.1)}),
      Case("outside", {"ship_wash"}, {Named({"unknown"}, 0.9), Named({"waves"}, 0.1)}),
      Case("nominal", {}, {Named({"unknown"}, 1.0)}),
  });
  ASSERT_EQ(seen.size(), 3u) << "the last one names no other cause";
  EXPECT_FALSE(seen[0].is_another);
  EXPECT_FALSE(seen[0].is_weather);
  EXPECT_TRUE(seen[1].is_another);
  EXPECT_TRUE(seen[1].is_weather);
  EXPECT_TRUE(seen[2].is_another);
  EXPECT_EQ(seen[0].regressors.at("misfit"), 0.5);
}

// A diagnosis without the true effect cannot know what resembles it, nor the weather that is there.
TEST(ObservationsOf, CountStrangersThatCanBeToldAlone) {
  const auto without = [](const std::string& named) {
    Scored scored = Case("single", {"thruster_lag"}, {});
    scored.label.weather = {"wind"};
    scored.left_out = Case("", {}, {Named({named}, 0.9)}).report;
    return ObservationsOf({scored});
  };
  EXPECT_EQ(without("thruster_delay").size(), 0u);
  EXPECT_EQ(without("wind").size(), 0u);
  ASSERT_EQ(without("hull_fouling").size(), 1u);
  EXPECT_TRUE(without("hull_fouling")[0].is_another);
  EXPECT_TRUE(without("hull_fouling")[0].is_left_out);
}

std::vector<Observation> Drawn(double constant, double slope, std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<Observation> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = normal(random);
    const bool another = uniform(random) < 1.0 / (1.0 + std::exp(-constant - slope * x));
    drawn.push_back({.regressors = {{"constant", 1.0}, {"x", x}}, .is_another = another});
  }
  return drawn;
}

// Standard errors of 20000 draws are 0.02 and 0.03 by the information p (1 - p) x x'.
TEST(FitLogistic, RecoversTheWeightsThatDrewTheOutcomes) {
  const LogisticModel model = FitLogistic(Drawn(-1.0, 2.0, 20000), {"constant", "x"}, 0.0);
  EXPECT_NEAR(model.weights.at("constant"), -1.0, 0.08);
  EXPECT_NEAR(model.weights.at("x"), 2.0, 0.12);
}

// At the minimum of the loss the residuals are orthogonal to every regressor.
TEST(FitLogistic, LeavesResidualsThatAreOrthogonalToTheRegressors) {
  const auto drawn = Drawn(0.5, 1.5, 200);
  const LogisticModel model = FitLogistic(drawn, {"constant", "x"}, 0.0);
  double sum = 0.0;
  double along = 0.0;
  for (const Observation& one : drawn) {
    const double residual = (one.is_another ? 1.0 : 0.0) - model.Probability(one);
    sum += residual;
    along += residual * one.regressors.at("x");
  }
  EXPECT_NEAR(sum, 0.0, 1e-5);
  EXPECT_NEAR(along, 0.0, 1e-5);
}

// Outcomes that a regressor separates have no likeliest weight; the ridge keeps it finite.
TEST(FitLogistic, StaysFiniteWhereARegressorSeparatesTheOutcomes) {
  const std::vector<Observation> separated = {
      {.regressors = {{"constant", 1.0}, {"x", -1.0}}, .is_another = false},
      {.regressors = {{"constant", 1.0}, {"x", 1.0}}, .is_another = true}};
  const LogisticModel model = FitLogistic(separated, {"constant", "x"}, 1e-3);
  EXPECT_GT(model.weights.at("x"), 1.0);
  EXPECT_TRUE(std::isfinite(model.weights.at("x")));
}

TEST(FitLogistic, RefusesWhatItCannotFit) {
  const std::vector<Observation> alike = {{.regressors = {{"constant", 1.0}}}};
  EXPECT_THROW(FitLogistic(alike, {"constant"}, 0.0), std::invalid_argument);
  EXPECT_THROW(FitLogistic(Drawn(0.0, 1.0, 20), {"constant", "y"}, 0.0), std::invalid_argument);
}

TEST(BlindFit, RefusesBadOptionsByName) {
  const telltale::TemporaryFolder folder;
  const std::string path = folder.Path().string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--set-dir", path}, "--reports"},
      {{"--set-dir", path, "--set-dir", path, "--reports", path}, "--reports"},
      {{"--set-dir", path, "--reports", path, "--ridge", "2"}, "--ridge"}};
  for (const auto& [options, name] : wrong) {
    std::vector<std::string> words{BLIND_FIT};
    words.insert(words.end(), options.begin(), options.end());
    const telltale::CommandOutcome outcome = telltale::RunCommand(words);
    EXPECT_EQ(outcome.exit_code, 2) << name;
    EXPECT_THAT(outcome.err, testing::HasSubstr(name));
  }
}

}  // namespace
}  // namespace blind::fit
