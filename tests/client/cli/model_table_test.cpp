#include "telltale/client/cli/model_table.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/identifiability.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/client/cli/discrete_table.hpp"
#include "telltale/client/cli/metrics_table.hpp"
#include "telltale/client/cli/regressor_words.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

using testing::HasSubstr;
using testing::Not;

void ExpectNoLineBeyondTheTerminal(const std::string& text) {
  EXPECT_EQ(kTerminalColumns, 80u);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(DisplayWidth(line), kTerminalColumns) << line;
  }
}

HeldOutScore MadeUpScore() {
  FreeRunScores scores;
  scores.horizon_s = 5.0;
  scores.velocity.fill({0.0456, 0.03, 0.9, 0.0789, 0.0012});
  scores.position_rmse_m = 0.321;
  scores.windows = 7;
  HeldOutScore score;
  score.training_s = 480.0;
  score.held_out_s = 120.0;
  score.metrics.free_run = {scores};
  return score;
}

std::string Unwrapped(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// The widest numbers that four significant digits can make.
Identification WithWideNumbers(Parameterization parameterization) {
  Identification wide = MadeUpIdentification(parameterization);
  for (Coefficient& coefficient : wide.coefficients) {
    coefficient.estimate = -1.234e-05;
    coefficient.standard_error = 1.23e-05;
    coefficient.interval = {0.95, -1.234e-05, -1.234e-06};
    coefficient.status = CoefficientStatus::kNotExcited;
  }
  return wide;
}

TEST(ModelTable, FitsATerminal) {
  for (const auto parameterization : {Parameterization::kPropeller, Parameterization::kPaper}) {
    ExpectNoLineBeyondTheTerminal(ModelTable(MadeUpIdentification(parameterization)));
    ExpectNoLineBeyondTheTerminal(DiscreteTable(MadeUpIdentification(parameterization)));
    ExpectNoLineBeyondTheTerminal(DiscreteTable(WithWideNumbers(parameterization)));
  }
  ExpectNoLineBeyondTheTerminal(ModelTable(WithWideNumbers(Parameterization::kPropeller)));
  ExpectNoLineBeyondTheTerminal(ModelTable(WithWideNumbers(Parameterization::kPaper)));
  ExpectNoLineBeyondTheTerminal(ModelTable(WithIdentifiability(MadeUpIdentification())));
  ExpectNoLineBeyondTheTerminal(ModelTable(MadeUpIdentification(), MadeUpScore()));
}

TEST(ModelTable, SaysOfThePhysicalFormWhatEachNumberIs) {
  Identification physical = MadeUpPhysicalIdentification();
  physical.coefficients[4].estimate = physical.coefficients[4].standard_error = 0.0;
  const std::string table = ModelTable(physical);
  ExpectNoLineBeyondTheTerminal(table);
  for (const char* text :
       {"physical model in Fossen's form, estimated by the prediction-error method",
        "m22   mass in sway", "Tf2   forward thrust, quadratic", "delay_fixes behind headings",
        "Coefficients that the parameters imply", "not in this form"}) {
    EXPECT_THAT(Unwrapped(table), HasSubstr(text));
  }
}

TEST(ModelTable, ShowsSimulationParametersWhereTheyDiffer) {
  EXPECT_THAT(ModelTable(MadeUpIdentification()),
              HasSubstr("Values for simulation: the estimates"));
  const std::string table = ModelTable(MadeUpIdentificationWithSimulationParameters());
  ExpectNoLineBeyondTheTerminal(table);
  EXPECT_THAT(table, HasSubstr("Values for simulation: regularised"));
  EXPECT_THAT(table, HasSubstr("-0.1667"));                 // half of the first estimate
  EXPECT_LT(table.find("-0.1667"), table.find("-0.3333"));  // which comes with the rest
}

// ---- the verdict
// ---------------------------------------------------------------------------------

TEST(ModelVerdict, LeadsTheTableWithTheErrorOnDataSetAside) {
  const std::string table = ModelTable(MadeUpIdentification(), MadeUpScore());
  const std::size_t verdict = table.find("Prediction of the last 120 s");
  ASSERT_NE(verdict, std::string::npos) << table;
  EXPECT_LT(verdict, table.find("Values for simulation"));
  for (const char* text : {"made from the first 480 s", "5 s ahead", "surge 0.046 m/s (0.079)",
                           "yaw 0.046 rad/s (0.079)", "position 0.32 m"}) {
    EXPECT_THAT(Unwrapped(table), HasSubstr(text));
  }
}

TEST(ModelVerdict, SaysHowToGetAScoreWhereThereIsNone) {
  EXPECT_THAT(Unwrapped(ModelTable(MadeUpIdentification())), HasSubstr("`telltale validate`"));
}

TEST(ModelVerdict, SaysThatThePredictionDiverges) {
  HeldOutScore score = MadeUpScore();
  score.metrics.free_run[0].velocity[1].rmse = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Unwrapped(ModelTable(MadeUpIdentification(), score)),
              HasSubstr("it diverges within 5 s"));
}

TEST(ModelVerdict, SaysWhetherTheModelCanBeSimulated) {
  Identification model = MadeUpIdentification();
  EXPECT_THAT(ModelTable(model), HasSubstr("Simulation: possible; free runs"));
  EXPECT_THAT(Unwrapped(ModelTable(MadeUpIdentificationWithSimulationParameters())),
              HasSubstr("Simulation: possible with the regularised values below"));
  model.refusals.push_back({"free run", "in 3 of 9 runs the model diverges", "record more"});
  EXPECT_THAT(ModelTable(model), HasSubstr("Simulation: not advised"));
  std::erase_if(model.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  EXPECT_THAT(ModelTable(model), HasSubstr("Simulation: not possible"));
}

TEST(ModelVerdict, NamesTheBestManoeuvre) {
  EXPECT_THAT(Unwrapped(ModelTable(WithIdentifiability(MadeUpIdentification()))),
              HasSubstr("Next: zigzag for 120 s would shrink"));
  EXPECT_THAT(ModelTable(MadeUpIdentification()), HasSubstr("Next: add a zigzag at two speeds"));
}

TEST(RegressorWords, NameEveryRegressor) {
  for (const auto parameterization : {Parameterization::kPropeller, Parameterization::kPaper}) {
    for (const Equation equation : kEquations) {
      for (const Regressor& regressor : Regressors(equation, parameterization)) {
        EXPECT_NE(RegressorInWords(equation, regressor.name), "") << regressor.name;
      }
    }
  }
  EXPECT_EQ(RegressorInWords(Equation::kSurge, "u"), "damping, linear");
  EXPECT_EQ(RegressorInWords(Equation::kYaw, "v"), "sway, linear");
  EXPECT_EQ(RegressorInWords(Equation::kYaw, "f:d"), "forward thrust, linear");
  EXPECT_EQ(RegressorInWords(Equation::kYaw, "speed"), "");
}

TEST(ModelTable, ShowsEverythingTheModelRestsOn) {
  const std::string table = Unwrapped(ModelTable(MadeUpIdentification()));
  for (const char* text : {"made-up.1",
                           "static quadratic",
                           "h = 0.2 s",
                           "95 % bounds",
                           "SURGE",
                           "SWAY",
                           "YAW",
                           "f:d   forward thrust, linear",
                           "Pu11",
                           "-0.3333",
                           "1/(m s)",
                           "not excited",
                           "[-∞, ∞]",
                           "sway: v and v|v| move together",
                           "add a zigzag at two speeds",
                           "3003 rows in 3 segments, 41 slices",
                           "gnss 7 DUPLICATE, thrusters 2 NOT_FINITE rejected",
                           "a cluster bootstrap over segments",
                           "1000 replicates",
                           "3 of them unsolved"}) {
    EXPECT_THAT(table, HasSubstr(text));
  }
}

TEST(ModelTable, ShowsTheLagWithItsBoundsAndTheDeadZone) {
  const std::string table = ModelTable(MadeUpDynamicIdentification());
  ExpectNoLineBeyondTheTerminal(table);
  EXPECT_THAT(table, HasSubstr("first order dynamic"));
  EXPECT_THAT(table, HasSubstr("thruster time constant 0.2500 s, 95 % bounds [0.2300, 0.2700]"));
  EXPECT_THAT(table, HasSubstr("no thrust from -0.06250 to 0.05000 of full command"));
  Identification none = MadeUpIdentification();
  none.dead_zone = {};
  EXPECT_THAT(ModelTable(none), Not(HasSubstr("dead zone")));
}

TEST(ModelTable, ARefusedEquationHasNoHeading) {
  Identification partial = MadeUpIdentification();
  std::erase_if(partial.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  EXPECT_THAT(ModelTable(partial), Not(HasSubstr("SWAY   dv/dt")));
  EXPECT_THAT(ModelTable(MadeUpIdentification()), HasSubstr("SWAY   dv/dt"));
}

TEST(DiscreteTable, HoldsTheCoefficientsTimesThePeriod) {
  Identification model = MadeUpIdentification();
  model.coefficients[0].estimate = -1.5;  // times 0.2
  EXPECT_THAT(DiscreteTable(model), HasSubstr("-0.3000"));
}

// exp(-0.2 / 0.25) = 0.449329, and the bounds of tau carried over: exp(-0.2 / 0.23), exp(-0.2 /
// 0.27).
TEST(DiscreteTable, HoldsAlpha) {
  const std::string table = DiscreteTable(MadeUpDynamicIdentification());
  ExpectNoLineBeyondTheTerminal(table);
  EXPECT_THAT(table, HasSubstr("alpha = exp(-h / tau) = 0.4493, 95 % bounds [0.4191, 0.4768]"));
  EXPECT_THAT(DiscreteTable(MadeUpIdentification()), Not(HasSubstr("alpha")));
}

Metrics MadeUpMetrics() {
  Metrics metrics;
  metrics.one_step.fill({0.99, 0.0123, 0.95});
  FreeRunScores scores;
  scores.horizon_s = 5.0;
  scores.velocity.fill({0.0456, 0.03, 0.9, 0.0789, 0.0012});
  scores.position_rmse_m = 0.321;
  scores.windows = 7;
  metrics.free_run.push_back(scores);
  return metrics;
}

TEST(MetricsTable, PutsConstantVelocityAndTheNoiseFloorBesideTheModel) {
  const std::string table = MetricsTable(MadeUpMetrics());
  ExpectNoLineBeyondTheTerminal(table);
  for (const char* text : {"R2 of constant velocity", "0.9500", "0.0123", "5 s: 7 windows",
                           "0.0456", "0.0789", "0.00120", "0.321 m"}) {
    EXPECT_THAT(table, HasSubstr(text));
  }
}

TEST(MetricsTable, SaysWhereTheModelDiverges) {
  Metrics metrics = MadeUpMetrics();
  metrics.free_run[0].velocity[0].rmse = 1e80;
  metrics.free_run[0].velocity[1].rmse = std::numeric_limits<double>::quiet_NaN();
  const std::string table = MetricsTable(metrics);
  ExpectNoLineBeyondTheTerminal(table);
  EXPECT_THAT(table, HasSubstr("in some of which the model diverges"));
  EXPECT_THAT(table, HasSubstr("diverges"));
  EXPECT_THAT(table, Not(HasSubstr("e+80")));
}

TEST(MetricsTable, SaysWhereNoWindowFits) {
  Metrics metrics = MadeUpMetrics();
  metrics.free_run[0].windows = 0;
  EXPECT_THAT(MetricsTable(metrics), HasSubstr("no segment without gaps is this long"));
}

TEST(ModelTable, ShowsGnssDriftWhereThereIsSome) {
  Identification model = MadeUpIdentification();
  EXPECT_THAT(ModelTable(model), HasSubstr("fixes drift by 6.0 cm"));
  model.disturbance->gnss_drift_m = 0.0;
  EXPECT_THAT(ModelTable(model), Not(HasSubstr("drift")));
  model.disturbance.reset();
  EXPECT_THAT(ModelTable(model), Not(HasSubstr("drift")));
}

}  // namespace
}  // namespace telltale
