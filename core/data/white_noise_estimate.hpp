#pragma once

#include "telltale/core/data/time_series.hpp"

namespace telltale {

/// One sigma of the white noise on a series, in its unit: the median size of its fourth-order
/// divided differences, each scaled so that white noise of one sigma gives one sigma, over the
/// median size of a standard normal variable. The differences vanish on cubics at any spacing in
/// time. The median disregards the instants at which a command steps. Assumes: noise that is white
/// from sample to sample and near Gaussian. Slower noise (GNSS drift, a filtered heading) counts as
/// motion. Zero for a series shorter than five samples.
double WhiteNoise(const TimeSeries& series);

}  // namespace telltale
