#pragma once

#include <span>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/data/sampling_grid.hpp"
#include "telltale/core/data/segment_signals.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// Positions on a grid, in {n}: of the antenna as read, of the body origin without the lever arm.
struct BodyPath {
  std::vector<double> x_m;
  std::vector<double> y_m;
};

/// Turns antenna positions into those of the body origin: the antenna sits at p + R(psi) l.
void RemoveLeverArm(BodyPath& path, std::span<const double> psi, const LeverArm& arm);

/// The body velocity R(psi)^T (dx, dy) / h of a displacement in {n}; r stays zero.
Nu ToBody(double psi, double dx, double dy, double period_s);

/// One row a grid point with its time and the propeller region of its interval; the rest is zero.
std::vector<PreparedRow> EmptyRows(const SegmentSignals& signals, const SamplingGrid& grid);

void FillPoses(std::vector<PreparedRow>& rows, const BodyPath& path, std::span<const double> psi);

}  // namespace telltale
