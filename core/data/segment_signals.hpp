#pragma once

#include "telltale/core/data/held_commands.hpp"
#include "telltale/core/data/north_east_frame.hpp"
#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/samples.hpp"
#include "telltale/core/data/segments.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// What was recorded along one segment, each channel at its own times.
struct SegmentSignals : RawSignals {
  HeldCommands commands;
};

/// The samples of one segment as positions in {n}, unwrapped headings and normalised commands.
SegmentSignals ReadSignals(const Recording& recording, const Segment& segment,
                           const Vehicle& vehicle, const NorthEastFrame& frame);

}  // namespace telltale
