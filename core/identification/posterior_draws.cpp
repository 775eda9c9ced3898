#include "identification/posterior_draws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>
#include <boost/random/normal_distribution.hpp>

#include "contract.hpp"
#include "random.hpp"

namespace telltale {
namespace {

// An eigenvalue this far below zero, as a share of the largest, is rounding and worth no note.
constexpr double kRounding = 1e-10;

struct SquareRoot {
  Eigen::MatrixXd root;
  double clipped = 0.0;
};

SquareRoot SymmetricRoot(const Eigen::MatrixXd& covariance) {
  // A coefficient that is known exactly has no correlation; dividing by one leaves its zeros alone.
  const Eigen::VectorXd deviations = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = deviations.unaryExpr([](double sd) { return sd > 0.0 ? sd : 1.0; });
  const Eigen::MatrixXd correlation =
      scale.cwiseInverse().asDiagonal() * covariance * scale.cwiseInverse().asDiagonal();
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

/// The standard deviation of ln tau, where it can be drawn at all.
std::optional<double> LogDeviation(const Coefficient& time_constant) {
  const double relative = time_constant.standard_error / time_constant.estimate;
  if (!(relative <= 1.0)) return std::nullopt;
  return relative;
}

}  // namespace

Result<PosteriorDraws> DrawFromPosterior(const Identification& identification, std::size_t count,
                                         std::uint64_t seed) {
  Require(count >= 1, "at least one draw");
  const auto size = static_cast<Eigen::Index>(identification.coefficients.size());
  Require(identification.covariance.rows() == size && identification.covariance.cols() == size,
          "a covariance over all coefficients");
  PosteriorDraws draws;
  Eigen::VectorXd estimates(size);
  std::vector<Eigen::Index> drawn;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Coefficient& coefficient = identification.coefficients[static_cast<std::size_t>(i)];
    estimates[i] = coefficient.estimate;
    if (std::isfinite(identification.covariance(i, i))) {
      drawn.push_back(i);
    } else {
      draws.not_drawn.push_back(std::string(Name(coefficient.equation)) + ' ' +
                                coefficient.regressor);
    }
  }
  if (drawn.empty()) {
    return Refuse("draws", "not one coefficient of the model has a finite variance",
                  "identify from data that excite the boat, with bounds");
  }
  const SquareRoot square_root = SymmetricRoot(identification.covariance(drawn, drawn));
  draws.clipped = square_root.clipped;

  std::optional<double> log_deviation;
  if (identification.thruster_time_constant) {
    log_deviation = LogDeviation(*identification.thruster_time_constant);
    if (!log_deviation) draws.not_drawn.emplace_back("thruster time constant");
  }
  draws.theta = estimates.replicate(1, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    RandomEngine engine = RandomEngine::Stream(seed, i);
    boost::random::normal_distribution<double> normal(0.0, 1.0);
    Eigen::VectorXd whitened(static_cast<Eigen::Index>(drawn.size()));
    for (double& value : whitened) value = normal(engine);
    draws.theta(drawn, static_cast<Eigen::Index>(i)) += square_root.root * whitened;
    if (!identification.thruster_time_constant) continue;
    const double tau = identification.thruster_time_constant->estimate;
    draws.time_constant_s.push_back(tau * std::exp(log_deviation.value_or(0.0) * normal(engine)));
  }
  return draws;
}

}  // namespace telltale
