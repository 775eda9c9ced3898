#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/uncertainty/clustered_fit.hpp"

namespace telltale {

/// The instants at which any of some fits has rows, ascending, and their runs: ranges of places in
/// `instants` whose values count up by one. A regression has no row across a gap, so a gap always
/// ends a run.
struct Timeline {
  std::vector<std::size_t> instants;
  std::vector<RowRange> runs;
};

Timeline TimelineOf(const std::vector<ClusteredFit>& fits);

/// A fit's rows in order of time. Shapes: rows n x (r + 1), row-major, each a row of W and its
/// residual; the rows of place t are [first[t], first[t + 1]), possibly none.
struct RowsInTime {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows;
  std::vector<std::size_t> first;
};

RowsInTime RowsAlong(const Timeline& timeline, const ClusteredFit& fit);

/// What each instant adds to theta, to first order: basis sum_i w_i e_i over its rows i, the
/// influence function. Shapes: places x p.
Eigen::MatrixXd InfluenceAlong(const Timeline& timeline, const ClusteredFit& fit);

}  // namespace telltale
