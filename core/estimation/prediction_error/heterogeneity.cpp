#include "telltale/core/estimation/prediction_error/heterogeneity.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/prediction_error/score_covariance.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

// The least share of the information on a direction that a recording, and all others, need to have
// to be compared along it.
constexpr double kLeastShare = 0.1;

struct Deviations {
  double squares = 0.0;  ///< of standard deviations
  double directions = 0.0;
};

// Of a recording's score, which varies by I_r - I_r I^-1 I_r about zero once the fit has taken its
// part.
Deviations DeviationsOf(const ScoreBlock& recording, const PredictionErrorFit& fit,
                        double dispersion) {
  const Eigen::LLT<Eigen::MatrixXd> root{fit.information};
  const auto lower = root.matrixL();
  const auto whitened = [&](const Eigen::MatrixXd& information) {
    const Eigen::MatrixXd half = lower.solve(information);
    return Eigen::MatrixXd(lower.solve(Eigen::MatrixXd(half.transpose())));
  };
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(whitened(recording.information));
  const Eigen::MatrixXd others = whitened(fit.data_information - recording.information);
  const Eigen::VectorXd score = eigen.eigenvectors().transpose() * lower.solve(recording.score);
  Deviations deviations;
  for (Eigen::Index i = 0; i < score.size(); ++i) {
    const Eigen::VectorXd direction = eigen.eigenvectors().col(i);
    const double share = eigen.eigenvalues()[i];
    if (share < kLeastShare || direction.dot(others * direction) < kLeastShare) continue;
    deviations.squares += score[i] * score[i] / (dispersion * share * (1.0 - share));
    deviations.directions += 1.0;
  }
  return deviations;
}

// What the fit loses with the recording, to first order, in the parameter that it moves most. Those
// whose value the prior would decide without it are not compared.
RecordingDifference DifferenceOf(const ScoreBlock& recording, const PredictionErrorFit& fit,
                                 const FossenPrior& prior, double dispersion) {
  const Eigen::MatrixXd& information = fit.information;
  const Eigen::MatrixXd without = Eigen::MatrixXd(information - recording.information).inverse();
  const Eigen::MatrixXd variance =
      recording.information - recording.information * information.inverse() * recording.information;
  const Eigen::VectorXd move = without * recording.score;
  const Eigen::VectorXd move_variance = dispersion * (without * variance * without).diagonal();
  double largest = 0.0;
  double compared = 0.0;
  RecordingDifference difference;
  for (Eigen::Index i = 0; i < move.size(); ++i) {
    if (prior.Decides(i, std::sqrt(without(i, i)))) continue;
    if (move_variance[i] <= kLeastShare * kLeastShare * without(i, i)) continue;
    compared += 1.0;
    const double deviations = std::abs(move[i]) / std::sqrt(move_variance[i]);
    if (deviations <= largest) continue;
    largest = deviations;
    difference.parameter = static_cast<FossenParameter>(i);
    difference.without = std::clamp(fit.parameters[i] + move[i], prior.least[i], prior.greatest[i]);
  }
  const double tails = 2.0 * StudentTail(static_cast<double>(fit.blocks.size()), largest);
  if (compared > 0.0) difference.p_value = std::min(compared * tails, 1.0);
  return difference;
}

}  // namespace

Heterogeneity HeterogeneityOf(const PredictionErrorFit& fit, const FossenPrior& prior) {
  Heterogeneity all;
  if (fit.recordings.size() < 2) return all;
  const double dispersion = DispersionOf(fit);
  Deviations sum;
  for (const ScoreBlock& recording : fit.recordings) {
    const Deviations one = DeviationsOf(recording, fit, dispersion);
    all.recordings.push_back(DifferenceOf(recording, fit, prior, dispersion));
    sum.squares += one.squares;
    sum.directions += one.directions;
  }
  if (sum.directions > 0.0) all.birge_ratio = std::sqrt(sum.squares / sum.directions);
  return all;
}

}  // namespace telltale
