#pragma once

#include "telltale/client/report/markup.hpp"
#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// What a page shows of a diagnosis. Each says in words where there is nothing to show. "Before" is
/// the model as it was given, "after" the model with the likely effects, drawn only where some are.

/// Whether effects are likely, so that there is an after.
bool HasAfter(const Diagnosis& diagnosis);

/// Error before and after against the floor, by horizon and channel.
Markup GapBars(const Diagnosis& diagnosis);

/// Error of window after window, the floor and the onset.
Markup ErrorOverTime(const Diagnosis& diagnosis);

/// Error by propeller region and speed, as a table.
Markup ErrorMap(const Diagnosis& diagnosis);

/// Error by heading, octant by octant.
Markup HeadingRose(const Diagnosis& diagnosis);

/// The missing force over speed, commands, heading and time, with 95 % intervals.
Markup MissingForceCharts(const Diagnosis& diagnosis);

/// Causes with probabilities, parameters and how much of the excess error each explains.
Markup CauseCards(const Diagnosis& diagnosis);

/// The windows with the largest error, as measured and as predicted.
Markup PathPictures(const Diagnosis& diagnosis);

/// What the colours and strokes of the pictures stand for; `measured` where paths are drawn.
Markup Legend(const Diagnosis& diagnosis, bool measured);

/// An empty state.
Markup Nothing(std::string_view why);

}  // namespace telltale
