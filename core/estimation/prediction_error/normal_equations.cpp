#include "telltale/core/estimation/prediction_error/normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"

namespace telltale {
namespace {

constexpr Eigen::Index kParameters = static_cast<Eigen::Index>(kFossenParameters);

// The slopes, or the instruments, of so many innovations from `first` on, each over the standard
// deviation of its innovation.
Eigen::MatrixXd Standardised(const SlopedInnovations& run, FossenVector InnovationSlope::*member,
                             std::size_t first, std::size_t count) {
  Eigen::MatrixXd columns(kParameters, count);
  for (std::size_t k = 0; k < count; ++k) {
    columns.col(static_cast<Eigen::Index>(k)) =
        run.slopes[first + k].*member / std::sqrt(run.innovations[first + k].variance);
  }
  return columns;
}

Eigen::MatrixXd Standardised(const SlopedInnovations& run, FossenVector InnovationSlope::*member) {
  return Standardised(run, member, 0, run.slopes.size());
}

Eigen::VectorXd StandardisedValues(const SlopedInnovations& run, std::size_t first,
                                   std::size_t count) {
  Eigen::VectorXd values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Innovation& i = run.innovations[first + k];
    values[static_cast<Eigen::Index>(k)] = i.value / std::sqrt(i.variance);
  }
  return values;
}

// The normal equations of one segment by blocks of time.
std::vector<ScoreBlock> BlocksOf(const SlopedInnovations& run, double block_s) {
  const std::vector<Innovation>& innovations = run.innovations;
  std::vector<ScoreBlock> blocks;
  for (auto begin = innovations.begin(); begin != innovations.end();) {
    const auto end = std::ranges::upper_bound(begin, innovations.end(), begin->time_s + block_s, {},
                                              &Innovation::time_s);
    const auto first = static_cast<std::size_t>(begin - innovations.begin());
    const auto count = static_cast<std::size_t>(end - begin);
    const Eigen::MatrixXd instruments =
        Standardised(run, &InnovationSlope::instrument, first, count);
    blocks.push_back({OfRoot(instruments), instruments * StandardisedValues(run, first, count)});
    begin = end;
  }
  return blocks;
}

}  // namespace

NormalEquations NormalEquationsOf(const SlopedRuns& runs, const PreparedDataset& dataset,
                                  double block_s) {
  NormalEquations normal{
      Eigen::MatrixXd::Zero(kParameters, kParameters), Eigen::VectorXd::Zero(kParameters), {}, {}};
  normal.recordings.resize(dataset.Recordings());
  for (std::size_t s = 0; s < runs.size(); ++s) {
    ScoreBlock& recording = normal.recordings[dataset.RecordingOf(s)];
    for (const ScoreBlock& block : BlocksOf(runs[s], block_s)) {
      recording.information += block.information;
      recording.score += block.score;
      normal.blocks.push_back(block);
    }
  }
  for (const ScoreBlock& recording : normal.recordings) {
    normal.information += recording.information;
    normal.gradient += recording.score;
  }
  return normal;
}

Eigen::MatrixXd ScoreSlope(const SlopedRuns& runs) {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(kParameters, kParameters);
  for (const SlopedInnovations& run : runs) {
    slope.noalias() += Standardised(run, &InnovationSlope::instrument) *
                       Standardised(run, &InnovationSlope::slope).transpose();
  }
  return slope;
}

double StrengthOfInstruments(const SlopedRuns& runs, const NormalEquations& normal,
                             const Eigen::MatrixXd& precision_of_prior) {
  Eigen::MatrixXd of_slopes = precision_of_prior;
  for (const SlopedInnovations& run : runs) {
    of_slopes += OfRoot(Standardised(run, &InnovationSlope::slope));
  }
  return of_slopes.ldlt().solve(normal.information).trace() / static_cast<double>(kParameters);
}

double WeightedSquares(const std::vector<Innovation>& innovations) {
  double squares = 0.0;
  for (const Innovation& i : innovations) squares += i.value * i.value / i.variance;
  return squares;
}

}  // namespace telltale
