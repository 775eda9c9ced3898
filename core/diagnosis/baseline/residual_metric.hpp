#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/diagnosis/baseline/nominal_baseline.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/sensitivity.hpp"

namespace telltale {

/// What may vary besides, by what it does to the errors, stacked window by window: one column of
/// one standard deviation each.
struct ErrorVariation {
  Eigen::MatrixXd by_window;  ///< in each window on its own
  Eigen::MatrixXd drifting;   ///< as a Gauss-Markov process does
  double drift_time_s = 0.0;  ///< its time constant
  /// Which columns of by_window are those of spells that last a window.
  std::vector<Eigen::Index> spells = {};

  bool IsEmpty() const { return by_window.size() == 0 && drifting.size() == 0; }
};

/// Whitens the errors of one recording and marginalises what varies in a nominal boat: scatter from
/// window to window, coefficients and fixed effects by their covariance, and a day's weather.
/// Model: (y, z) = kappa y' V^-1 z with V the nominal covariance of all errors together, by the
/// matrix inversion lemma; docs/concepts/diagnosis.md (87).
class ResidualMetric {
 public:
  /// Only the given windows count. `free_coefficients`: coefficients may follow the recording as
  /// they like.
  ResidualMetric(const NominalBaseline& nominal, const Sensitivity& recording,
                 std::vector<std::size_t> windows, bool free_coefficients);

  /// The same, where besides each window's errors may vary, on their own, by what the columns do to
  /// them. Shapes: errors stacked window by window, one column a unit of what varies.
  ResidualMetric WithWindowVariation(const Eigen::MatrixXd& varying) const;

  /// The same, where what drifts does so too. Its slow part runs through the recording; what is
  /// faster varies window by window. Requires: the times of the windows where anything drifts.
  ResidualMetric WithVariation(const ErrorVariation& variation) const;

  /// The same, where besides each window's errors scatter, on their own, with this covariance.
  /// Shapes: rows x rows.
  ResidualMetric WithWindowScatter(const Eigen::MatrixXd& covariance) const;

  /// The same, where the whole recording may besides vary by what the columns do to it, stacked
  /// window by window, one standard deviation each.
  ResidualMetric WithFree(const Eigen::MatrixXd& columns) const;

  const std::vector<std::size_t>& Windows() const { return windows_; }
  bool FreesCoefficients() const { return frees_coefficients_; }

  /// The errors of a model (rows x all windows) as they count: whitened, of the windows that count,
  /// none larger than that of a diverged model.
  Eigen::VectorXd Whiten(const Eigen::MatrixXd& errors) const;

  /// Columns of stacked errors likewise, however large.
  Eigen::MatrixXd WhitenColumns(const Eigen::MatrixXd& stacked) const;

  /// Whitened errors times V^-1: what nominal variation does not explain.
  Eigen::MatrixXd Marginalise(const Eigen::MatrixXd& whitened) const;

  double SquaredMahalanobis(const Eigen::VectorXd& whitened) const {
    return whitened.dot(Marginalise(whitened).col(0));
  }

  /// SquaredMahalanobis as a share of what a nominal boat is expected to leave: about one.
  double ReducedChiSquare(const Eigen::VectorXd& whitened) const {
    return SquaredMahalanobis(whitened) / ExpectedSquare();
  }

  /// The square that a nominal boat is expected to leave.
  double ExpectedSquare() const;

  /// Rows of errors per effective observation.
  double RowsPerObservation() const {
    return static_cast<double>(factor_.rows()) / kDiagnosis.metric.observations_per_window;
  }

  /// Effective independent observations of the recording: errors within a window are correlated,
  /// and so is what a model leaves wrong everywhere.
  double EffectiveObservations() const;

  /// -2 ln of the evidence that a parameter costs by the Bayesian information criterion: ln n, n
  /// effective observations, two at least.
  double ParameterPenalty() const;

  /// -2 ln of how much likelier what leaves one square is than what leaves the other, if the scale
  /// of errors is not known: n ln(square / than), n effective observations;
  /// docs/concepts/diagnosis.md (89).
  double Deviance(double square, double than) const;

  /// What allowing for more costs: ln of how much wider it makes all windows, counted by effective
  /// observations.
  double VariationPenalty() const { return variation_penalty_; }

  /// By how many sigmas something shows, counted by effective observations.
  double Sigmas(const Eigen::VectorXd& whitened) const;

  /// Whitened errors less the most probable nominal variation.
  Eigen::VectorXd Unexplained(const Eigen::VectorXd& whitened) const {
    return Marginalise(whitened).col(0);
  }

  /// The same by window, rows x windows, of unit variance for a nominal boat.
  Eigen::MatrixXd UnexplainedByWindow(const Eigen::VectorXd& whitened) const;

  /// How the coefficients most probably differ from the nominal boat's, and how certain that is.
  /// Units: standard errors of the model.
  struct Recalibration {
    Eigen::VectorXd change;
    Eigen::MatrixXd covariance;
  };
  Recalibration Recalibrate(const Eigen::VectorXd& whitened) const;

  double Kappa() const { return kappa_; }

  /// L^-1 pattern L^-T of a second moment of one window's errors.
  Eigen::MatrixXd WhitenMoment(const Eigen::MatrixXd& pattern) const;

 private:
  void FactoriseNuisance();
  void DeflateWindowVariation(Eigen::MatrixXd& whitened) const;

  std::vector<std::size_t> windows_;
  Eigen::ArrayXd times_s_;  // of all windows
  bool frees_coefficients_;
  Eigen::MatrixXd covariance_;  // of a window's errors
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double kappa_;
  Eigen::MatrixXd nuisance_;  // whitened, one column a unit of what may vary
  Eigen::LLT<Eigen::MatrixXd> nuisance_factor_;
  Eigen::MatrixXd
      coefficient_root_;  // rows of the coefficients in the root of the boat's covariance
  // Of each window what is allowed to vary, D of (I + b b')^(-1/2) = I - D D'; side by side.
  Eigen::MatrixXd window_variation_;
  double variation_penalty_ = 0.0;
};

/// Nats that so many effective observations yield against what adds this share to the square that
/// the truth leaves.
inline double LogEvidenceOf(double effective_observations, double share) {
  return 0.5 * effective_observations * std::log1p(share);
}

/// Of L L'.
double LogDeterminant(const Eigen::LLT<Eigen::MatrixXd>& factor);

/// L^-1 applied to every window of every column, L L' the covariance of a window.
Eigen::MatrixXd Whitened(const Eigen::LLT<Eigen::MatrixXd>& factor, const Eigen::MatrixXd& stacked);

std::vector<std::size_t> EveryWindow(const Sensitivity& recording);

}  // namespace telltale
