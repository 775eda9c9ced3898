#include "telltale/core/identification/posterior_draws.hpp"

#include <cmath>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/identification/physical_range.hpp"
#include "telltale/core/uncertainty/truncated_normal.hpp"

namespace telltale {
namespace {

// An eigenvalue this far below zero, as a share of the largest, is rounding and not reported.
constexpr double kRounding = 1e-10;

struct SquareRoot {
  Eigen::MatrixXd root;
  double clipped = 0.0;
};

SquareRoot SymmetricRoot(const Eigen::MatrixXd& covariance) {
  // A coefficient that is known exactly has no correlation; dividing by one leaves its zeros alone.
  const Eigen::VectorXd deviations = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = deviations.unaryExpr([](double sd) { return sd > 0.0 ? sd : 1.0; });
  const Eigen::MatrixXd correlation = Scaled(covariance, scale.cwiseInverse());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  const Eigen::VectorXd& eigenvalues = solver.eigenvalues();  // ascending
  const double largest = eigenvalues[eigenvalues.size() - 1];
  SquareRoot result;
  if (eigenvalues[0] < -kRounding * largest) result.clipped = -eigenvalues[0] / largest;
  result.root = scale.asDiagonal() * solver.eigenvectors() *
                eigenvalues.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                solver.eigenvectors().transpose();
  return result;
}

/// Whether ln tau can be drawn: a normal law about it means something only while its deviation is
/// moderate.
bool CanBeDrawn(const Coefficient& time_constant) {
  return time_constant.standard_error <= time_constant.estimate;
}

/// The covariance with ln tau as one more row and column, by the delta method: d ln tau = d tau /
/// tau.
Eigen::MatrixXd WithLogTimeConstant(const Eigen::MatrixXd& covariance,
                                    const Eigen::VectorXd& with_tau,
                                    const Coefficient& time_constant) {
  const double tau = time_constant.estimate;
  const Eigen::Index n = covariance.rows();
  Eigen::MatrixXd joint(n + 1, n + 1);
  joint.topLeftCorner(n, n) = covariance;
  joint.topRightCorner(n, 1) = with_tau / tau;
  joint.bottomLeftCorner(1, n) = with_tau.transpose() / tau;
  joint(n, n) = std::pow(time_constant.standard_error / tau, 2);
  return joint;
}

PosteriorDraws DrawPhysicalForm(const PhysicalModel& physical, std::size_t count,
                                std::uint64_t seed) {
  const FossenVector estimates = physical.Estimates();
  const PhysicalRange range = RangeOf(physical);
  // The model's covariance is that of parameters within their range.
  const Eigen::MatrixXd untruncated =
      CovarianceBeforeTruncation(estimates, physical.covariance, range.least, range.greatest);
  const Eigen::MatrixXd parameters = DrawTruncatedNormal(estimates, untruncated, range.least,
                                                         range.greatest, estimates, count, seed);
  PosteriorDraws draws;
  draws.theta.resize(CoefficientsOf(estimates, physical.propeller_separation_m).size() - 1,
                     parameters.cols());
  for (Eigen::Index i = 0; i < parameters.cols(); ++i) {
    const Eigen::VectorXd coefficients =
        CoefficientsOf(WithPositiveMass(parameters.col(i)), physical.propeller_separation_m);
    draws.theta.col(i) = coefficients.head(draws.theta.rows());
    draws.time_constant_s.push_back(coefficients[draws.theta.rows()]);
  }
  return draws;
}

/// The coefficients of finite variance, by their places; the others are named in the draws.
std::vector<Eigen::Index> DrawnCoefficients(const Identification& identification,
                                            PosteriorDraws& draws) {
  std::vector<Eigen::Index> drawn;
  for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    if (std::isfinite(identification.covariance(place, place))) {
      drawn.push_back(place);
    } else {
      const Coefficient& coefficient = identification.coefficients[i];
      draws.not_drawn.push_back(std::string(Name(coefficient.equation)) + ' ' +
                                coefficient.regressor);
    }
  }
  return drawn;
}

Eigen::VectorXd StandardNormal(Eigen::Index size, std::uint64_t seed, std::size_t stream) {
  RandomEngine engine = RandomEngine::Stream(seed, stream);
  boost::random::normal_distribution<double> normal(0.0, 1.0);
  Eigen::VectorXd values(size);
  for (double& value : values) value = normal(engine);
  return values;
}

void RequireCovariances(const Identification& identification) {
  const auto size = static_cast<Eigen::Index>(identification.coefficients.size());
  Require(identification.covariance.rows() == size && identification.covariance.cols() == size,
          "a covariance over all coefficients");
  Require(identification.time_constant_covariance.size() ==
              (identification.thruster_time_constant ? size : 0),
          "a covariance of the time constant, where there is one, with every coefficient");
}

}  // namespace

Result<PosteriorDraws> DrawFromPosterior(const Identification& identification, std::size_t count,
                                         std::uint64_t seed) {
  Require(count >= 1, "at least one draw");
  if (identification.physical) return DrawPhysicalForm(*identification.physical, count, seed);
  RequireCovariances(identification);
  PosteriorDraws draws;
  const std::vector<Eigen::Index> drawn = DrawnCoefficients(identification, draws);
  if (drawn.empty()) {
    return Refuse("draws", "not one coefficient of the model has a finite variance",
                  "identify from data that excite the boat, with bounds");
  }
  Eigen::MatrixXd covariance = identification.covariance(drawn, drawn);
  const auto& time_constant = identification.thruster_time_constant;
  const bool draws_lag = time_constant && CanBeDrawn(*time_constant);
  if (draws_lag) {
    covariance = WithLogTimeConstant(covariance, identification.time_constant_covariance(drawn),
                                     *time_constant);
  } else if (time_constant) {
    draws.not_drawn.emplace_back("thruster time constant");
  }
  const SquareRoot square_root = SymmetricRoot(covariance);
  draws.clipped = square_root.clipped;

  draws.theta = identification.Estimates().replicate(1, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::VectorXd shift = square_root.root * StandardNormal(covariance.rows(), seed, i);
    draws.theta(drawn, static_cast<Eigen::Index>(i)) +=
        shift.head(static_cast<Eigen::Index>(drawn.size()));
    if (!time_constant) continue;
    const double log_shift = draws_lag ? shift[shift.size() - 1] : 0.0;
    draws.time_constant_s.push_back(time_constant->estimate * std::exp(log_shift));
  }
  return draws;
}

}  // namespace telltale
