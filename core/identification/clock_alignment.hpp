#pragma once

#include "telltale/core/base/result.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/identification/options.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// How much later than their stamps say, by the clock of the headings, commands act and fixes are
/// stamped. Units: seconds.
struct ClockDelays {
  double commands_s = 0.0;
  double fixes_s = 0.0;

  bool Any() const { return commands_s != 0.0 || fixes_s != 0.0; }
};

/// The recording as it would be without the delays.
Recording WithoutDelays(Recording recording, const ClockDelays& delays);

/// A recording prepared for the weak form, without the delays between its channels.
struct AlignedDataset {
  PreparedDataset dataset;
  ClockDelays removed;
  ClockDelays standard_errors;  ///< of what is removed; zero where nothing is
};

/// PrepareForWeakIv(), with evident delays of the commands and of the fixes removed. The weak form
/// estimates what is left of them together with the coefficients: a delay is removed where it is
/// longer than 25 ms and five of its standard errors, and estimated again until it changes by less
/// than 2 ms. Commands that act before their stamps were sampled: they are half a period old at
/// their stamps on average, and spread over twice the delay, SensorProperties::command_spread_s.
/// Refuses when: PrepareForWeakIv does.
/// Source: docs/concepts/model.md (36).
Result<AlignedDataset> PrepareWithClocksAligned(const Recording& recording, const Vehicle& vehicle,
                                                const IdentifyOptions& options);

/// Says which delays the data show. `bounds_carry_them`: whether the model's bounds hold what is
/// not known of them.
Refusal WarnOfDelays(const AlignedDataset& aligned, bool bounds_carry_them);

}  // namespace telltale
