#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <boost/random/normal_distribution.hpp>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

/// Windows of a short recording by a baseline of independent errors, with what waves add.
class StochasticExcitationTest : public ::testing::Test {
 protected:
  /// Normal errors of the covariance given, rows x windows.
  Eigen::MatrixXd Draw(const Eigen::MatrixXd& covariance) const {
    RandomEngine engine(5);
    boost::random::normal_distribution<double> normal;
    Eigen::MatrixXd white(covariance.rows(), static_cast<Eigen::Index>(short_.runs.Windows()));
    for (double& value : white.reshaped()) value = normal(engine);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
    return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * white;
  }

  EffectFit FitTo(const Eigen::MatrixXd& errors) const {
    return FitStochasticExcitation(*waves_, problem_, metric_, errors, 2);
  }

  const Effect* waves_ = FindEffect("waves");
  const std::vector<const Effect*> library_ = {waves_};
  const testing::ShortRecording short_{300.0};
  const NominalBaseline nominal_ = [this] {
    NominalBaseline nominal = testing::UnitBaseline(short_.runs.Rows(), 0, 0);
    nominal.covariance *= 1e-4;
    return nominal;
  }();
  const Sensitivity recording_ =
      testing::SensitivityOfErrors(short_.runs.Errors(nominal_.boat), 0, 0);
  const ResidualMetric metric_{nominal_, recording_, EveryWindow(recording_), false};
  const FrequencyResponse response_{library_, short_.runs, nominal_.boat, recording_.errors, 2};
  const std::vector<EffectParameterRef> no_parameters_;
  const DiagnosisProblem problem_{short_.runs, nominal_,       recording_,
                                  metric_,     no_parameters_, response_};
};

TEST_F(StochasticExcitationTest, FindsTheFrequencyThatScattersTheWindows) {
  const FrequencyResponse::Band& band = response_.Of(*waves_)[6];
  const Eigen::MatrixXd excess = 0.25 * (band.patterns[0] + band.patterns[1] + band.patterns[2]);
  const EffectFit fit = FitTo(Draw(nominal_.covariance + excess));
  EXPECT_EQ(fit.effects[0].values[3], band.frequency_rad_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(fit.effects[0].values[axis], 0.5, 0.25) << axis;
  }
  EXPECT_LT(fit.score, 0.0);
}

TEST_F(StochasticExcitationTest, HasNoEvidenceInNominalScatter) {
  const Eigen::MatrixXd errors = Draw(nominal_.covariance);
  const EffectFit fit = FitTo(errors);
  EXPECT_GT(fit.score, 0.0);
  EXPECT_EQ(fit.errors, errors);
}

// Scatter that grows alike in all rows is no narrow band.
TEST_F(StochasticExcitationTest, HasNoEvidenceInWhiteScatterThatGrew) {
  EXPECT_GT(FitTo(Draw(4.0 * nominal_.covariance)).score, -8.0);
}

TEST_F(StochasticExcitationTest, MeanSquaresGrowWithTheSquareOfTheAmplitude) {
  EffectFit fit;
  fit.effects = {{waves_, {0.1, 0.1, 0.1, 2.5}}};
  const Eigen::VectorXd once = StochasticMeanSquares(fit, short_.runs, nominal_.boat);
  fit.effects = {{waves_, {0.2, 0.2, 0.2, 2.5}}};
  const Eigen::VectorXd twice = StochasticMeanSquares(fit, short_.runs, nominal_.boat);
  EXPECT_GT(once.minCoeff(), 0.0);
  EXPECT_TRUE(twice.isApprox(4.0 * once, 1e-9));
  fit.effects = {{FindEffect("thruster_lag"), {0.3}}};
  EXPECT_EQ(StochasticMeanSquares(fit, short_.runs, nominal_.boat).norm(), 0.0);
}

TEST(WithStochasticEffect, StacksEffectsAndCovariancesAndAddsScores) {
  EffectFit lag;
  lag.effects = {{FindEffect("thruster_lag"), {0.3}}};
  lag.covariance = Eigen::MatrixXd::Constant(1, 1, 2.0);
  lag.score = -20.0;
  EffectFit waves;
  waves.effects = {{FindEffect("waves"), {0.1, 0.1, 0.1, 2.5}}};
  waves.covariance = Eigen::MatrixXd::Identity(4, 4);
  waves.score = -15.0;
  const EffectFit both = WithStochasticEffect(lag, waves);
  EXPECT_EQ(both.Names(), (std::vector<std::string>{"thruster_lag", "waves"}));
  EXPECT_EQ(both.covariance.diagonal(), (Eigen::VectorXd(5) << 2.0, 1.0, 1.0, 1.0, 1.0).finished());
  EXPECT_EQ(both.score, -35.0);
}

}  // namespace
}  // namespace telltale
