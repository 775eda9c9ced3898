#include "telltale/core/estimation/prediction_error/score_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/uncertainty/distributions.hpp"

namespace telltale {
namespace {

constexpr double kFewestDegreesOfFreedom = 4.0;
// A block that alone informs a direction has all of its leverage; its score says nothing there.
constexpr double kMostLeverage = 0.9;

// The block's score as it would be with the parameters known.
Eigen::VectorXd UnbiasedScore(const ScoreBlock& block,
                              const Eigen::LLT<Eigen::MatrixXd>& information) {
  const auto lower = information.matrixL();
  const Eigen::MatrixXd half = lower.solve(block.information);
  const Eigen::MatrixXd leverage = lower.solve(Eigen::MatrixXd(half.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(leverage);
  const Eigen::VectorXd scale =
      (1.0 - eigen.eigenvalues().array().min(kMostLeverage)).rsqrt().matrix();
  const Eigen::VectorXd white = lower.solve(block.score);
  const Eigen::VectorXd scaled =
      eigen.eigenvectors() * scale.cwiseProduct(eigen.eigenvectors().transpose() * white);
  return lower * scaled;
}

Eigen::MatrixXd CovarianceOfScores(const std::vector<ScoreBlock>& blocks,
                                   const Eigen::LLT<Eigen::MatrixXd>& information) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  for (const ScoreBlock& block : blocks) {
    const Eigen::VectorXd score = UnbiasedScore(block, information);
    covariance += score * score.transpose();
  }
  return covariance;
}

// Of the scores over what the information expects of them.
double DispersionOf(const Eigen::MatrixXd& scores, const PredictionErrorFit& fit,
                    const Eigen::LLT<Eigen::MatrixXd>& information) {
  return information.solve(scores).trace() / information.solve(fit.data_information).trace();
}

// Scatter between the recordings in place of that between blocks of time; 0 of one recording.
double DispersionByRecordings(const PredictionErrorFit& fit,
                              const Eigen::LLT<Eigen::MatrixXd>& information) {
  const auto recordings = static_cast<double>(fit.recordings.size());
  if (fit.recordings.size() < 2) return 0.0;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  for (const ScoreBlock& recording : fit.recordings) {
    squares += recording.score * recording.score.transpose();
  }
  return recordings / (recordings - 1.0) * DispersionOf(squares, fit, information);
}

// Satterthwaite's, of a variance that is the sum over the blocks.
Eigen::VectorXd DegreesOfFreedom(const PredictionErrorFit& fit, const Eigen::MatrixXd& by_score) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kFossenParameters);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(kFossenParameters);
  for (const ScoreBlock& block : fit.blocks) {
    const Eigen::VectorXd share = (by_score * block.information * by_score.transpose()).diagonal();
    sum += share;
    squares += share.cwiseAbs2();
  }
  return sum.cwiseAbs2().cwiseQuotient(squares.cwiseMax(1e-300)).array() - 1.0;
}

Eigen::VectorXd StudentWidening(const Eigen::VectorXd& degrees_of_freedom, double level) {
  const double upper = 0.5 * (1.0 + level);
  return degrees_of_freedom.unaryExpr([upper](double degrees) {
    return StudentQuantile(std::max(degrees, kFewestDegreesOfFreedom), upper) /
           NormalQuantile(upper);
  });
}

// Of each parameter's score over what the information expects of it, standard deviations.
Eigen::VectorXd OwnScatter(const Eigen::MatrixXd& scores, const Eigen::MatrixXd& information) {
  return scores.diagonal().cwiseQuotient(information.diagonal().cwiseMax(1e-300)).cwiseSqrt();
}

// What brings the standard errors of `covariance` to those of `other` where these are larger.
Eigen::VectorXd WideningTo(const Eigen::MatrixXd& other, const Eigen::MatrixXd& covariance) {
  return other.diagonal().cwiseQuotient(covariance.diagonal()).cwiseMax(1.0).cwiseSqrt();
}

// Of the blocks' own covariance beside the shape of the information.
double WeightOf(std::size_t blocks) {
  return static_cast<double>(blocks) / static_cast<double>(blocks + kFossenParameters);
}

}  // namespace

Eigen::MatrixXd RobustCovariance::ForSingles() const {
  return Scaled(covariance, own_widening);
}

std::size_t EquivalentBlocks(std::size_t blocks) {
  if (blocks == 0) return 0;
  const double weight = WeightOf(blocks);
  return static_cast<std::size_t>(std::lround(static_cast<double>(blocks) / (weight * weight)));
}

double DispersionOf(const PredictionErrorFit& fit) {
  const Eigen::LLT<Eigen::MatrixXd> root{fit.information};
  return DispersionOf(CovarianceOfScores(fit.blocks, root), fit, root);
}

RobustCovariance CovarianceOf(const PredictionErrorFit& fit, double level) {
  const Eigen::MatrixXd& information = fit.information;
  const Eigen::LLT<Eigen::MatrixXd> root(information);
  const Eigen::MatrixXd by_score = fit.slope.inverse();
  const Eigen::MatrixXd of_blocks = CovarianceOfScores(fit.blocks, root);
  const double dispersion = DispersionOf(of_blocks, fit, root);
  const double inflation = std::max(1.0, DispersionByRecordings(fit, root) / dispersion);
  const double weight = WeightOf(fit.blocks.size());
  const Eigen::MatrixXd prior = information - fit.data_information;
  const auto shrunk_to = [&](const Eigen::MatrixXd& target) {
    const Eigen::MatrixXd scores = weight * of_blocks + (1.0 - weight) * target;
    return Eigen::MatrixXd(Mapped(by_score, inflation * scores + prior));
  };
  const Eigen::MatrixXd alike = shrunk_to(dispersion * fit.data_information);
  const Eigen::MatrixXd apart =
      shrunk_to(Scaled(fit.data_information, OwnScatter(of_blocks, fit.data_information)));
  const Eigen::VectorXd degrees = DegreesOfFreedom(fit, by_score) / (weight * weight);
  const Eigen::VectorXd widening =
      StudentWidening(degrees, level).cwiseProduct(WideningTo(apart, alike));
  const double common = std::sqrt(widening.cwiseAbs2().mean());
  return {common * common * alike, widening / common, degrees};
}

}  // namespace telltale
