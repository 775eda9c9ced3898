#pragma once

#include <optional>
#include <vector>

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepare_options.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Whether a dataset keeps the readings behind its rows, which take as much memory as these.
/// One-step least squares and the weak form read rows and commands alone.
enum class Readings { kKept, kLeftOut };

/// Brings the channels of a recording onto one grid, with velocities and the commands behind them;
/// docs/concepts/data-preparation.md.
/// Assumes: the recording's channels are in order of time and share one clock.
/// Refuses when: an option is out of range, a channel is empty, or no segment without gaps is long
/// enough.
/// Source: the paper, Data Preparation.
Result<PreparedDataset> Prepare(const Recording& recording, const Vehicle& vehicle,
                                const PrepareOptions& options, Readings readings = Readings::kKept);

/// Why Prepare() refuses a recording; nothing: it does not. It takes neither the time nor the
/// memory of the rows.
std::optional<Refusal> WhyNotPrepared(const Recording& recording, const PrepareOptions& options);

/// The rows of one segment as Prepare() makes them. Readings that are predicted become rows that
/// compare with recorded ones: both pass the same filter.
/// Requires: a grid no shorter than the smoothing window.
std::vector<PreparedRow> PrepareRows(const SegmentSignals& signals, const SamplingGrid& grid,
                                     const LeverArm& antenna, const PrepareOptions& options);

}  // namespace telltale
