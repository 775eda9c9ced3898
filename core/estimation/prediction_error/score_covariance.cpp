#include "telltale/core/estimation/prediction_error/score_covariance.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr double kFewestDegreesOfFreedom = 4.0;
// A block that alone informs a direction has all of its leverage; its score says nothing there.
constexpr double kMostLeverage = 0.9;

// The block's score as it would be with the parameters known.
FossenVector UnbiasedScore(const ScoreBlock& block, const Eigen::LLT<FossenSquare>& information) {
  const auto lower = information.matrixL();
  const FossenSquare half = lower.solve(block.information);
  const FossenSquare leverage = lower.solve(FossenSquare(half.transpose()));
  const Eigen::SelfAdjointEigenSolver<FossenSquare> eigen(leverage);
  const FossenVector scale =
      (1.0 - eigen.eigenvalues().array().min(kMostLeverage)).rsqrt().matrix();
  const FossenVector white = lower.solve(block.score);
  const FossenVector scaled =
      eigen.eigenvectors() * scale.cwiseProduct(eigen.eigenvectors().transpose() * white);
  return lower * scaled;
}

FossenSquare CovarianceOfScores(const std::vector<ScoreBlock>& blocks,
                                const Eigen::LLT<FossenSquare>& information) {
  FossenSquare covariance = FossenSquare::Zero();
  for (const ScoreBlock& block : blocks) {
    const FossenVector score = UnbiasedScore(block, information);
    covariance += score * score.transpose();
  }
  return covariance;
}

// Of the scores over what the information expects of them.
double DispersionOf(const FossenSquare& scores, const PredictionErrorFit& fit,
                    const Eigen::LLT<FossenSquare>& information) {
  return information.solve(scores).trace() /
         information.solve(FossenSquare(fit.data_information)).trace();
}

// Scatter between the recordings in place of that between blocks of time; 0 of one recording.
double DispersionByRecordings(const PredictionErrorFit& fit,
                              const Eigen::LLT<FossenSquare>& information) {
  const auto recordings = static_cast<double>(fit.recordings.size());
  if (fit.recordings.size() < 2) return 0.0;
  FossenSquare squares = FossenSquare::Zero();
  for (const ScoreBlock& recording : fit.recordings) {
    squares += recording.score * recording.score.transpose();
  }
  return recordings / (recordings - 1.0) * DispersionOf(squares, fit, information);
}

// Satterthwaite's, of a variance that is the sum over the blocks.
FossenVector DegreesOfFreedom(const PredictionErrorFit& fit, const FossenSquare& by_score) {
  FossenVector sum = FossenVector::Zero();
  FossenVector squares = FossenVector::Zero();
  for (const ScoreBlock& block : fit.blocks) {
    const FossenVector share = (by_score * block.information * by_score.transpose()).diagonal();
    sum += share;
    squares += share.cwiseAbs2();
  }
  return sum.cwiseAbs2().cwiseQuotient(squares.cwiseMax(1e-300)).array() - 1.0;
}

FossenVector StudentWidening(const FossenVector& degrees_of_freedom, double level) {
  const double upper = 0.5 * (1.0 + level);
  return degrees_of_freedom.unaryExpr([upper](double degrees) {
    return StudentQuantile(std::max(degrees, kFewestDegreesOfFreedom), upper) /
           NormalQuantile(upper);
  });
}

// Of each parameter's score over what the information expects of it, standard deviations.
FossenVector OwnScatter(const FossenSquare& scores, const FossenSquare& information) {
  return scores.diagonal().cwiseQuotient(information.diagonal().cwiseMax(1e-300)).cwiseSqrt();
}

// What brings the standard errors of `covariance` to those of `other` where these are larger.
FossenVector WideningTo(const FossenSquare& other, const FossenSquare& covariance) {
  return other.diagonal().cwiseQuotient(covariance.diagonal()).cwiseMax(1.0).cwiseSqrt();
}

// Of the blocks' own covariance beside the shape of the information.
double WeightOf(std::size_t blocks) {
  return static_cast<double>(blocks) / static_cast<double>(blocks + kFossenParameters);
}

}  // namespace

std::size_t EquivalentBlocks(std::size_t blocks) {
  if (blocks == 0) return 0;
  const double weight = WeightOf(blocks);
  return static_cast<std::size_t>(std::lround(static_cast<double>(blocks) / (weight * weight)));
}

double DispersionOf(const PredictionErrorFit& fit) {
  const Eigen::LLT<FossenSquare> root{FossenSquare(fit.information)};
  return DispersionOf(CovarianceOfScores(fit.blocks, root), fit, root);
}

RobustCovariance CovarianceOf(const PredictionErrorFit& fit, double level) {
  const FossenSquare information = fit.information;
  const Eigen::LLT<FossenSquare> root(information);
  const FossenSquare by_score = FossenSquare(fit.slope).inverse();
  const FossenSquare of_blocks = CovarianceOfScores(fit.blocks, root);
  const double dispersion = DispersionOf(of_blocks, fit, root);
  const double inflation = std::max(1.0, DispersionByRecordings(fit, root) / dispersion);
  const double weight = WeightOf(fit.blocks.size());
  const FossenSquare prior = information - fit.data_information;
  const auto shrunk_to = [&](const FossenSquare& target) {
    const FossenSquare scores = weight * of_blocks + (1.0 - weight) * target;
    return FossenSquare(Mapped(by_score, inflation * scores + prior));
  };
  const FossenSquare alike = shrunk_to(dispersion * fit.data_information);
  const FossenSquare apart =
      shrunk_to(Scaled(fit.data_information, OwnScatter(of_blocks, fit.data_information)));
  const FossenVector degrees = DegreesOfFreedom(fit, by_score) / (weight * weight);
  const FossenVector student = StudentWidening(degrees, level);
  return {Scaled(alike, student.cwiseProduct(WideningTo(apart, alike))), degrees};
}

}  // namespace telltale
