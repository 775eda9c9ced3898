#include "telltale/core/identification/shrinkage.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "support/made_up_identifications.hpp"

namespace telltale {
namespace {

Identification KnownTo(double relative_error) {
  Identification made = IdentificationByHand();
  for (std::size_t i = 0; i < made.coefficients.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const double error = relative_error * made.coefficients[i].estimate;
    made.covariance(place, place) = error * error;
  }
  return made;
}

TEST(RegularisedModel, UnregularisedIsWhatWasReported) {
  const VesselModel model = RegularisedModel(IdentificationByHand(), kUnregularised);
  EXPECT_EQ(model.discretisation, Discretisation::kContinuous);
  EXPECT_EQ(model.theta[0][0], 7.0);
  EXPECT_EQ(model.theta[0][5], 2.0);
  EXPECT_EQ(model.theta[2][9], 4.0);
}

/// A coefficient alone is shrunk by size^2 / (size^2 + variance).
TEST(RegularisedModel, ShrinksWhatIsIllDetermined) {
  const VesselModel sure = RegularisedModel(KnownTo(0.01), 1.0);
  const VesselModel unsure = RegularisedModel(KnownTo(2.0), 1.0);
  EXPECT_NEAR(sure.theta[0][0], 7.0 / (1.0 + 1e-4), 1e-9);
  EXPECT_NEAR(unsure.theta[0][0], 7.0 / 5.0, 1e-9);
  EXPECT_LT(RegularisedModel(KnownTo(2.0), 0.1).theta[0][0], 0.02);
}

/// The same about anything else: the estimate and the prior mean have weights by their variances.
TEST(RegularisedModel, ShrinksTowardsThePriorMeans) {
  const Identification made = KnownTo(2.0);
  const Eigen::VectorXd estimates = made.Estimates();
  const Eigen::VectorXd believed = Eigen::VectorXd::Constant(estimates.size(), 3.0);
  const Eigen::VectorXd regularised = RegularisedEstimates(made, estimates.cwiseAbs(), believed);
  EXPECT_NEAR(regularised[0], 3.0 + (7.0 - 3.0) / 5.0, 1e-9);
  EXPECT_TRUE(
      RegularisedEstimates(made, 1e6 * estimates.cwiseAbs(), believed).isApprox(estimates, 1e-6));
}

/// What two coefficients add up to is known, each of them is not: the sum stays.
TEST(RegularisedModel, KeepsWhatTheDataDetermine) {
  Identification made = IdentificationByHand();
  made.coefficients[0].estimate = 101.0;
  made.coefficients[1].estimate = -100.0;
  made.covariance *= 1e-6;
  made.covariance.topLeftCorner<2, 2>() << 1e4, -1e4, -1e4, 1e4;
  made.covariance.topLeftCorner<2, 2>().diagonal().array() += 1e-4;
  const VesselModel regularised = RegularisedModel(made, 0.1);
  EXPECT_LT(std::abs(regularised.theta[0][0]), 3.0);
  EXPECT_NEAR(regularised.theta[0][0] + regularised.theta[0][1], 1.0, 0.01);
}

TEST(RegularisedModel, LeavesARefusedEquationAtZero) {
  Identification made = IdentificationByHand();
  std::erase_if(made.coefficients, [](const auto& c) { return c.equation == Equation::kSway; });
  made.covariance = Eigen::MatrixXd::Identity(22, 22);
  const VesselModel model = RegularisedModel(made, 1.0);
  EXPECT_EQ(model.theta[1], Eigen::VectorXd::Zero(13));
  EXPECT_NE(model.theta[2][0], 0.0);
}

}  // namespace
}  // namespace telltale
