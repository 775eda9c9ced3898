#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/innovations.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

using SlopedRuns = std::vector<SlopedInnovations>;  // by segment

/// What the innovations of one block of time, or of one recording, say.
struct ScoreBlock {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kFossenParameters, kFossenParameters);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(kFossenParameters);
};

/// The equations of innovations and their instruments, each over the standard deviation of its
/// innovation. In the order of FossenParameter.
struct NormalEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;            ///< half of that of the sum of weighted squares
  std::vector<ScoreBlock> blocks;      ///< of the data, by time
  std::vector<ScoreBlock> recordings;  ///< the same by recordings
};

NormalEquations NormalEquationsOf(const SlopedRuns& runs, const PreparedDataset& dataset,
                                  double block_s);

/// How the data's score changes with the parameters.
Eigen::MatrixXd ScoreSlope(const SlopedRuns& runs);

/// How much more the instruments say of the parameters than the slopes do, on average over them.
double StrengthOfInstruments(const SlopedRuns& runs, const NormalEquations& normal,
                             const Eigen::MatrixXd& precision_of_prior);

/// The sum of their squares, each over its variance.
double WeightedSquares(const std::vector<Innovation>& innovations);

}  // namespace telltale
