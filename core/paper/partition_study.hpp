#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"

namespace telltale {

/// The unit by which rows are divided into training and validation. By points, nearly every
/// validation row has a neighbour 0.2 s away in the training set and is almost a copy of it, so the
/// score says little about new data. By slices, the score is one on new data.
enum class PartitionMethod { kUnknown, kBySlices, kByPoints };

std::string_view Name(PartitionMethod method);

struct PartitionOptions {
  RegressionOptions regression;  ///< the dynamic structure is fitted redundantly, as the paper does
  PartitionMethod method = PartitionMethod::kBySlices;
  std::size_t repeats = 20;         ///< random partitions, [1, 1000]
  double training_share = 0.7;      ///< of the rows, (0, 1)
  double validation_share = 0.3;    ///< of the rows, (0, 1); both together at most 1
  double free_run_horizon_s = 5.0;  ///< [2 h, 600]
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]; never changes the result

  /// The first field out of its range, as a refusal naming field, value and range.
  std::optional<Refusal> Validate() const;
};

/// Mean and standard deviation over the random partitions; zero deviation of one partition.
struct Spread {
  double mean = 0.0;
  double standard_deviation = 0.0;
};

/// Scores of one velocity. MAE and R2 are the paper's, of nu(k+1) predicted from the measured
/// nu(k). Free runs exist by slices alone, since validation points are not consecutive. They use
/// the consistent estimate of the training slices.
struct PartitionScores {
  Spread training_mae;
  Spread training_r2;
  Spread mae;
  Spread r2;
  Spread constant_velocity_r2;
  std::optional<Spread> free_run_rmse;
  std::optional<Spread> constant_velocity_free_run_rmse;
};

/// The paper's partition experiments, docs/concepts/model.md (24).
/// Source: the paper, Identification Experiments: 20 random 70/30 partitions, and training shares
/// of 70, 60 and 50 % with 30 % for validation. Refuses when: an option is out of range or there
/// are fewer than ten slices.
Result<std::array<PartitionScores, 3>> StudyPartitions(const PreparedDataset& dataset,
                                                       const PartitionOptions& options);

}  // namespace telltale
