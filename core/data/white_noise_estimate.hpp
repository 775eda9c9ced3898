#pragma once

#include "telltale/core/data/time_series.hpp"

namespace telltale {

/// One sigma of the white noise on a series, judged by what no smooth motion explains: its
/// fourth-order divided differences, each scaled so that white noise of one sigma gives one sigma.
/// They vanish on cubics whatever the spacing in time. The median of their sizes is taken, so that
/// the instants at which a command steps do not count.
///
/// Assumes: noise that is white from sample to sample and near Gaussian; slower noise (a drifting
/// GNSS solution, a filtered heading) passes for motion and is not seen.
/// Zero for a series shorter than five samples.
double WhiteNoise(const TimeSeries& series);

}  // namespace telltale
