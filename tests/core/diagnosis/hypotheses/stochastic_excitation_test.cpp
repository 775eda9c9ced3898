#include "telltale/core/diagnosis/hypotheses/stochastic_excitation.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <boost/random/normal_distribution.hpp>

#include "support/hand_made_diagnosis.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/residuals/frequency_response.hpp"

namespace telltale {
namespace {

/// Windows of a short recording by a baseline of independent errors of a centimetre, with what
/// waves add.
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

  /// A peak of half a metre per second squared and as many radians.
  ObservedExcitation Observed(double gain) const {
    ObservedExcitation observed;
    observed.peak.frequency_rad_s = 2.0;
    observed.peak.log_width = 0.3;
    observed.peak.squared_amplitudes.setConstant(0.25);
    observed.peak.gain = gain;
    observed.moments =
        MeanResponseMomentsOf(observed.peak.frequency_rad_s, observed.peak.log_width, short_.runs,
                              nominal_.boat, short_.runs.Errors(nominal_.boat));
    observed.scatter = ErrorCovarianceBy(observed.moments, observed.peak.squared_amplitudes);
    return observed;
  }

  EffectFit FitTo(const Eigen::MatrixXd& errors, double gain) const {
    const ObservedExcitation observed = Observed(gain);
    const Sensitivity recording = testing::SensitivityOfErrors(errors, 0, 0);
    const ResidualMetric metric(nominal_, recording, EveryWindow(recording), false);
    return FitStochasticExcitation(
        *waves_, observed, {short_.runs, nominal_, recording, metric, no_parameters_, observed},
        metric, errors);
  }

  const Effect* waves_ = FindEffect("waves");
  const testing::ShortRecording short_{300.0};
  const NominalBaseline nominal_ = [this] {
    NominalBaseline nominal = testing::UnitBaseline(short_.runs.Rows(), 0, 0);
    nominal.covariance *= 1e-4;
    return nominal;
  }();
  const std::vector<EffectParameterRef> no_parameters_;
};

// The factors are a few, the nearest to the truth is the likeliest of 60 windows.
TEST_F(StochasticExcitationTest, FindsByHowMuchTheWindowsScatterMore) {
  for (const double factor : {1.0, 2.0}) {
    const EffectFit fit = FitTo(Draw(nominal_.covariance + factor * Observed(0.0).scatter), 500.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_DOUBLE_EQ(fit.effects[0].values[axis], 0.5 * std::sqrt(factor)) << axis;
    }
    EXPECT_EQ(fit.effects[0].values[3], 2.0);
    EXPECT_TRUE(fit.scatter.isApprox(factor * Observed(0.0).scatter));
    EXPECT_LT(fit.score, -8.0);
  }
}

TEST_F(StochasticExcitationTest, HasNoMoreEvidenceThanThePeak) {
  const Eigen::MatrixXd errors = Draw(nominal_.covariance + Observed(0.0).scatter);
  EXPECT_EQ(FitTo(errors, 0.0).score, 0.0);
  EXPECT_EQ(FitTo(errors, 5.0).score, -5.0);
}

TEST_F(StochasticExcitationTest, HasNoEvidenceInNominalScatter) {
  const Eigen::MatrixXd errors = Draw(nominal_.covariance);
  const EffectFit fit = FitTo(errors, 500.0);
  EXPECT_GT(fit.score, 0.0);
  EXPECT_EQ(fit.errors, errors);
}

TEST_F(StochasticExcitationTest, RaisesMeanSquaresByItsScatter) {
  EffectFit fit;
  fit.effects = {{waves_, {0.5, 0.5, 0.5, 2.0}}};
  fit.scatter = Observed(0.0).scatter;
  EXPECT_EQ(StochasticMeanSquares(fit, short_.runs, nominal_.boat), fit.scatter.diagonal());
  fit.effects = {{FindEffect("thruster_lag"), {0.3}}};
  EXPECT_EQ(StochasticMeanSquares(fit, short_.runs, nominal_.boat).norm(), 0.0);
}

TEST_F(StochasticExcitationTest, ScattersWithTheSquareOfTheAmplitude) {
  const auto scatter = [&](double amplitude) {
    return ScatterOf(
        {{FindEffect("thruster_lag"), {0.3}}, {waves_, {amplitude, amplitude, amplitude, 2.0}}},
        short_.runs, nominal_.boat);
  };
  EXPECT_GT(scatter(0.1).diagonal().minCoeff(), 0.0);
  EXPECT_TRUE(scatter(0.2).isApprox(4.0 * scatter(0.1), 1e-9));
  EXPECT_EQ(scatter(0.0).norm(), 0.0);
}

/// A boat with a fault whose windows scatter besides as waves make them.
class FaultInWaves : public StochasticExcitationTest {
 protected:
  EffectFit Fitted() const {
    const testing::ShortRecording faulty(300.0, {{FindEffect("thrust_gain"), {0.3}}});
    const ObservedExcitation observed = Observed(500.0);
    const Eigen::MatrixXd waves = Draw(nominal_.covariance + observed.scatter);
    const Sensitivity recording =
        testing::SensitivityOfErrors(faulty.runs.Errors(nominal_.boat) + waves, 0, 0);
    const ResidualMetric metric(nominal_, recording, EveryWindow(recording), false);
    const DiagnosisProblem problem{faulty.runs, nominal_,       recording,
                                   metric,      no_parameters_, observed};
    return FitBeside(*waves_, problem, metric, {FindEffect("thrust_gain")},
                     Eigen::VectorXd::Zero(1));
  }
};

TEST_F(FaultInWaves, StandsFirstWithBothCovariances) {
  const EffectFit both = Fitted();
  EXPECT_EQ(both.Names(), (std::vector<std::string>{"thrust_gain", "waves"}));
  EXPECT_EQ(both.Stochastic(), waves_);
  EXPECT_EQ(both.covariance.rows(), 5);
  EXPECT_EQ(both.Deterministic().Names(), std::vector<std::string>{"thrust_gain"});
}

// Free runs of the recording are simulated anew by the fit, so that the waves of the test are not
// in them: it finds the fault exactly.
TEST_F(FaultInWaves, KeepsItsSize) {
  EXPECT_NEAR(Fitted().effects[0].values[0], 0.3, 0.03);
}

// The boat turns at random, and a current moves it as it turns: a peak, where no current is known.
TEST_F(StochasticExcitationTest, OfAKnownCurrentIsNone) {
  const std::vector<ModelledEffect> current = {{FindEffect("current"), {1.0, 0.5}}};
  const testing::ShortRecording carried(300.0, current);
  const Eigen::MatrixXd errors = carried.runs.Errors(nominal_.boat);
  const ObservedExcitation observed = ObservedExcitationOf(std::vector{waves_}, carried.runs,
                                                           {short_.dataset}, nominal_.boat, errors);
  EXPECT_GT(observed.peak.gain, 0.0);

  const Sensitivity recording = testing::SensitivityOfErrors(errors, 0, 0);
  const ResidualMetric metric(nominal_, recording, EveryWindow(recording), false);
  const DiagnosisProblem problem{carried.runs, nominal_,       recording,
                                 metric,       no_parameters_, observed};
  EXPECT_EQ(ExcitationBeside(*waves_, current, problem).peak.gain, 0.0);
}

}  // namespace
}  // namespace telltale
