#pragma once

#include <cstddef>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/effects/augmented_model.hpp"
#include "telltale/core/simulation/free_run.hpp"

namespace telltale {

/// Free runs of a model with effects along a dataset, from measured states.
class AugmentedFreeRuns {
 public:
  AugmentedFreeRuns(const PreparedDataset& dataset, const AugmentedModel& model);

  /// Calls visit(first row, predicted rows from it on) for every run of `rows` periods.
  template <class Visit>
  void RunAll(std::size_t rows, Visit visit) const {
    for (std::size_t s = 0; s < dataset_.segments.size(); ++s) {
      const RowRange& segment = dataset_.segments[s];
      if (segment.size() < 2) continue;
      const std::vector<Drive> drives = DrivesAlong(s);
      for (const std::size_t first : FreeRunStarts(segment, rows)) {
        visit(first, Run(segment, first, rows, drives));
      }
    }
  }

 private:
  std::vector<Drive> DrivesAlong(std::size_t segment) const;
  std::vector<PreparedRow> Run(const RowRange& segment, std::size_t first, std::size_t rows,
                               const std::vector<Drive>& drives) const;

  const PreparedDataset& dataset_;
  AugmentedBoat boat_;
  std::size_t steps_;
  double step_s_;
};

}  // namespace telltale
