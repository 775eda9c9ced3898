#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/diagnosis/healthy.hpp"
#include "telltale/core/diagnosis/sensitivity.hpp"
#include "telltale/core/linear_algebra/decompositions.hpp"

namespace telltale {

/// Independent looks at a boat that a window amounts to, docs/diagnosis.md (89).
inline constexpr double kLooksAWindow = 0.5;

/// Weighs the errors of one recording by what a healthy boat may do: scatter from window to window,
/// coefficients and lasting effects off by what their covariance leaves, and a day's weather.
/// Model: (y, z) = kappa y' V^-1 z with V the healthy covariance of all errors together, by the
/// matrix inversion lemma; docs/diagnosis.md (87).
class Judge {
 public:
  /// Only the given windows count. `free_base`: coefficients may follow the recording as they like.
  Judge(const Healthy& healthy, const Sensitivity& recording, std::vector<std::size_t> windows,
        bool free_base);

  /// The same, where besides each window's errors may vary, on their own, by what the columns do to
  /// them. Shapes: errors stacked window by window, one column a unit of what varies.
  Judge Allowing(const Eigen::MatrixXd& varying) const;

  const std::vector<std::size_t>& Windows() const { return windows_; }
  bool FreesBase() const { return frees_base_; }

  /// The errors of a model (rows x all windows) as they count: whitened, of the windows that count,
  /// none larger than a lost boat.
  Eigen::VectorXd See(const Eigen::MatrixXd& errors) const;

  /// Columns of stacked errors likewise, however large.
  Eigen::MatrixXd SeeColumns(const Eigen::MatrixXd& stacked) const;

  /// What is left of seen errors once all that may vary in health is weighed in.
  Eigen::MatrixXd Weigh(const Eigen::MatrixXd& seen) const;

  double Square(const Eigen::VectorXd& seen) const { return seen.dot(Weigh(seen).col(0)); }

  /// Square as a share of what a healthy boat is expected to leave: about one.
  double Leftover(const Eigen::VectorXd& seen) const { return Square(seen) / Expected(); }

  /// The square that a healthy boat is expected to leave.
  double Expected() const;

  /// Rows of errors that amount to one look.
  double RowsALook() const { return static_cast<double>(factor_.rows()) / kLooksAWindow; }

  /// How many independent looks at the boat the recording amounts to: errors within a window, and
  /// what a model leaves wrong everywhere alike, vary together.
  double Looks() const;

  /// -2 ln of how much likelier what leaves one square is than what leaves the other, if the scale
  /// of errors is not known: looks ln(square / than); docs/diagnosis.md (89).
  double Evidence(double square, double than) const;

  /// What allowing for more costs: ln of how much wider it makes all windows, counted by looks.
  double Allowance() const { return allowance_; }

  /// By how many sigmas something shows, counted by looks.
  double Sigmas(const Eigen::VectorXd& seen) const;

  /// Seen errors less the most probable part of what may vary in health.
  Eigen::VectorXd Unexplained(const Eigen::VectorXd& seen) const { return Weigh(seen).col(0); }

  /// The same by window, rows x windows, of unit variance in health.
  Eigen::MatrixXd UnexplainedByWindow(const Eigen::VectorXd& seen) const;

  /// How the coefficients most probably differ from the healthy boat's, and how certain that is.
  /// Units: standard errors of the model.
  struct Recalibration {
    Eigen::VectorXd change;
    Eigen::MatrixXd covariance;
  };
  Recalibration Recalibrate(const Eigen::VectorXd& seen) const;

  double Kappa() const { return kappa_; }

  /// L^-1 pattern L^-T of a second moment of one window's errors.
  Eigen::MatrixXd Whiten(const Eigen::MatrixXd& pattern) const;

 private:
  void WeighLoose();
  void DampAllowed(Eigen::MatrixXd& seen) const;

  std::vector<std::size_t> windows_;
  bool frees_base_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double kappa_;
  Eigen::MatrixXd loose_;  // as seen, one column a unit of what may vary
  Eigen::LLT<Eigen::MatrixXd> weigher_;
  Eigen::MatrixXd base_root_;  // rows of the coefficients in the root of the boat's covariance
  // Of each window what is allowed to vary, D of (I + b b')^(-1/2) = I - D D'; side by side.
  Eigen::MatrixXd allowed_;
  double allowance_ = 0.0;
};

/// Nats that so many looks yield against what adds this share to the square that the truth leaves.
inline double NatsOf(double looks, double share) {
  return 0.5 * looks * std::log1p(share);
}

/// L^-1 applied to every window of every column, L L' the covariance of a window.
Eigen::MatrixXd Whitened(const Eigen::LLT<Eigen::MatrixXd>& factor, const Eigen::MatrixXd& stacked);

std::vector<std::size_t> EveryWindow(const Sensitivity& recording);

}  // namespace telltale
