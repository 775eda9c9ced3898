#pragma once

#include <string>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/validation/validation.hpp"

namespace telltale {

/// A model over a recording: what was measured, what free runs predict, and what one step ahead
/// leaves.
struct ModelSeries {
  const Identification& model;
  const PreparedDataset& dataset;
  std::vector<FreeRun> free_runs;  ///< of the horizon asked for
  std::vector<FreeRun> one_step;   ///< of one sampling period
};

/// A row per instant of the dataset: time, measured position, heading, velocities and commands; the
/// same of the free run, the time at which that run began; and the residuals of one step. Empty
/// cells: no run reaches the instant, or it diverged. Numbers read back to the same bits.
std::string PrintSeriesCsv(const ModelSeries& series);

/// equation,regressor,symbol,estimate,standard_error,lower,upper,unit,status: the coefficients, and
/// of the physical form its parameters, whose equation is empty.
std::string PrintCoefficientsCsv(const Identification& model);

/// The same as JSON channels of an MCAP file, for Foxglove and PlotJuggler: /telltale/measured,
/// /telltale/free_run, /telltale/residuals, /telltale/position, which maps show, and
/// /telltale/coefficients with their bounds at the beginning. Values that are not finite are left
/// out.
std::string PrintSeriesMcap(const ModelSeries& series);

}  // namespace telltale
