#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/estimation/prediction_error/smoothed_states.hpp"
#include "telltale/core/identification/physical_model.hpp"
#include "telltale/core/simulation/free_run.hpp"

namespace telltale {

/// Free runs of the physical form along a dataset.
/// Each starts from the state that the model has of the readings before, and of those within the
/// window of the dataset's filter about the start, from which the recorded row is made too. What
/// fixes and headings would read along it replaces those recorded after its start, and passes the
/// filter of the dataset: predicted rows compare with recorded ones like with like.
/// Model: docs/concepts/physical-model.md (107)..(109).
class PhysicalFreeRuns {
 public:
  PhysicalFreeRuns(const PreparedDataset& dataset, const PhysicalModel& model);

  /// Calls visit(first row, predicted rows from it on) for every run of `rows` periods.
  template <class Visit>
  void RunAll(std::size_t rows, Visit visit) const {
    for (std::size_t s = 0; s < dataset_.segments.size(); ++s) {
      const auto firsts = FreeRunStarts(dataset_.segments[s], rows);
      const auto states = StatesAt(s, firsts);
      for (std::size_t i = 0; i < states.size(); ++i) {
        visit(firsts[i], Run({s, firsts[i], states[i]}, rows));
      }
    }
  }

 private:
  struct Start {
    std::size_t segment;
    std::size_t row;
    FilterState state;  // at StartTimeOf(row)
  };

  std::vector<FilterState> StatesAt(std::size_t segment,
                                    const std::vector<std::size_t>& rows) const;
  std::vector<FilterState> Predict(const Start& start, std::span<const double> stamps_s,
                                   double delay_s) const;
  void PredictHeadings(const Start& start, TimeSeries& psi_rad) const;
  void PredictFixes(const Start& start, RawSignals& signals) const;
  SegmentSignals Readings(const Start& start, const SamplingGrid& grid) const;
  RowRange RowsAbout(const RowRange& run, const RowRange& segment) const;
  std::vector<PreparedRow> Run(const Start& start, std::size_t rows) const;

  double FixDelay() const;
  double StartTimeOf(std::size_t row) const;

  const PreparedDataset& dataset_;
  FilterSettings settings_;
};

}  // namespace telltale
