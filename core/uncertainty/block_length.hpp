#pragma once

#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// The length of the blocks of a circular block bootstrap that makes the variances of the means of
/// these series most accurate: for each series the bias of its variance, (G / g)^2 / l^2 relative
/// to it, against its scatter, 4/3 l / n; here their sum over the series is least. G = sum |k|
/// R(k), g = sum R(k), autocovariances R through a flat-top lag window whose width follows from
/// where the correlogram becomes insignificant.
/// Shapes: series n x k, each column of mean zero; runs are ranges of rows without a gap, and no
/// product of an autocovariance straddles two of them. Returns a length in [1, min(3 sqrt(n), n /
/// 3)], at least 1. Assumes: stationarity within what the runs cover. A series without variance is
/// left out.
/// Source: Politis, White, "Automatic block-length selection for the dependent bootstrap",
/// Econometric Reviews 23 (2004); Patton, Politis, White, correction, Econometric Reviews 28
/// (2009): 4/3 for circular blocks, K_N = max(5, ceil(sqrt(log10 N))), c = 2.
std::size_t BlockLength(const Eigen::MatrixXd& series, const std::vector<RowRange>& runs);

}  // namespace telltale
