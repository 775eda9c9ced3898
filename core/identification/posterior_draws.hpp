#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// Models that the data allow: joint draws of the coefficients. Shapes:
/// theta (coefficients) x (draws), in the order of Identification::coefficients; time_constant_s
/// one value a draw for the dynamic structure, otherwise empty.
struct PosteriorDraws {
  Eigen::MatrixXd theta;
  std::vector<double> time_constant_s;
  /// Held at their estimate in every draw because their variance is infinite (zero where
  /// NOT_EXCITED): "SURGE vr", or "thruster time constant".
  std::vector<std::string> not_drawn;
  /// The most negative eigenvalue of the correlation matrix, set to zero, as a share of the
  /// largest; 0 where the covariance is one.
  double clipped = 0.0;
};

/// Of the physical form its parameters are drawn, from a normal law truncated to their physical
/// range that has the variances of the model, and turned into coefficients: every draw has a
/// positive definite mass matrix and drag that opposes the motion.
/// Method of every other structure: the symmetric square root of the correlation matrix by
/// eigenvalues, negative ones set to zero, so that a covariance of fewer replicates than
/// coefficients does no harm and no unit matters. The time constant is drawn together with the
/// coefficients through its logarithm, so that it stays positive: ln tau has the relative standard
/// error and, with each coefficient, the covariance over tau (delta method). It is not drawn when
/// its standard error exceeds its estimate. Determinism: draw i has a random engine of its own;
/// more draws with the same seed begin with the same ones. Refuses when: no coefficient has a
/// finite variance. Requires: count
/// >= 1.
Result<PosteriorDraws> DrawFromPosterior(const Identification& identification, std::size_t count,
                                         std::uint64_t seed);

}  // namespace telltale
