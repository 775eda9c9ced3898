#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/paper/partition_study.hpp"
#include "telltale/core/paper/redundant_least_squares.hpp"

namespace telltale {

struct StudyOptions {
  std::size_t repeats = 20;      ///< random partitions behind each mean, [1, 1000]
  bool include_reverse = false;  ///< take RR rows too
  std::uint64_t seed = 1;
  std::size_t threads = 1;  ///< [1, 256]; never changes the result
};

/// The scores of one structure under one partition method and training share.
struct StudyEntry {
  Structure structure = Structure::kUnknown;
  PartitionMethod method = PartitionMethod::kUnknown;
  double training_share = 0.0;
  std::size_t repeats = 0;
  std::array<PartitionScores, 3> scores;  ///< surge, sway, yaw
};

/// The paper's experiments on one dataset, in the paper's parameterization.
struct Study {
  std::vector<StudyEntry> partitions;  ///< both structures, both methods, 70/30
  std::vector<StudyEntry> shares;      ///< both structures by slices, training 70, 60, 50 %
  std::array<std::optional<Eigen::VectorXd>, 3>
      static_table;  ///< X as the paper prints it, times h
  std::array<std::optional<Eigen::VectorXd>, 3> dynamic_table;  ///< the redundant X
  std::optional<RedundantAlpha> redundant_alpha;
  std::optional<Coefficient> time_constant;  ///< of the consistent estimate
  std::vector<Refusal> refusals;             ///< for parts without an answer
};

/// Repeats the paper's partitions, training shares and coefficient tables; docs/concepts/model.md
/// (24). Refuses when: there are too few slices to partition.
Result<Study> StudyRecording(const PreparedDataset& dataset, const StudyOptions& options,
                             const Progress& progress = {});

}  // namespace telltale
