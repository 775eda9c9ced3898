#pragma once

namespace telltale {

/// A first-order lag under a held command falls back by exp(-t / tau) of what it was behind. Over one
/// sampling period, which ends with the share alpha = exp(-h / tau) left, it is behind by this share on
/// average: (1 - alpha) / -ln(alpha), zero without lag and one for an endless one.
double MeanLagShare(double alpha);

/// Its derivative by alpha.
double MeanLagShareSlope(double alpha);

}  // namespace telltale
