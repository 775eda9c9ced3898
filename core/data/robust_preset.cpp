#include "telltale/core/data/robust_preset.hpp"

#include <span>

#include "telltale/core/data/body_path.hpp"

namespace telltale {
namespace {

/// Mean body velocities of the intervals between grid points, as displacements a row.
struct Increments {
  std::vector<double> forward_m;
  std::vector<double> starboard_m;
};

// Displacements are turned into the body frame interval by interval, at the heading midway. A boat
// that turns on the spot or circles keeps u and v nearly constant, while its velocity north and
// east oscillates faster than a low-degree polynomial follows. The heading is the measured one:
// where a boat begins to turn, the error of a smoothed heading makes u look like sway, and the
// noise of the measured heading is negligible beside that of positions.
Increments BodyIncrements(const BodyPath& path, std::span<const double> psi) {
  Increments increments;
  for (std::size_t row = 0; row + 1 < psi.size(); ++row) {
    const Nu body = ToBody(0.5 * (psi[row] + psi[row + 1]), path.x_m[row + 1] - path.x_m[row],
                           path.y_m[row + 1] - path.y_m[row], 1.0);
    increments.forward_m.push_back(body.u);
    increments.starboard_m.push_back(body.v);
  }
  return increments;
}

// nu(k+1) - nu(k) is a weighted sum of the changes between the mean velocities of neighbouring
// intervals, and the change across t_i is h times the triangular mean about t_i of the
// acceleration. The command takes the same weights, so that row k pairs the command with the
// velocity change it caused: docs/concepts/data-preparation.md (4).
std::vector<PropellerCommand> FilterAsVelocity(const HeldCommands& commands,
                                               const SamplingGrid& grid,
                                               const SavitzkyGolay& filter) {
  std::vector<PropellerCommand> about(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    about[row] = commands.TriangularMean(grid.Time(row), grid.period_s);
  }
  const auto weight_of = [&](std::size_t row, std::size_t interval) {
    if (row >= grid.rows) return 0.0;
    const std::size_t start = filter.WindowStart(row, grid.rows);
    if (interval < start || interval + 1 >= start + filter.WindowLength()) return 0.0;
    return filter.IncrementWeight(row - start, interval - start);
  };
  std::vector<PropellerCommand> filtered(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const std::size_t start = filter.WindowStart(row, grid.rows);
    // The last row has no successor and takes the weights of its own window.
    const bool last = row + 1 == grid.rows;
    double weight = 0.0;
    for (std::size_t i = start; i + 1 < start + filter.WindowLength(); ++i) {
      weight = last ? weight_of(row, i) : weight + weight_of(row, i) - weight_of(row + 1, i);
      filtered[row].port += weight * about[i + 1].port;
      filtered[row].starboard += weight * about[i + 1].starboard;
    }
  }
  return filtered;
}

}  // namespace

std::vector<PreparedRow> PrepareRobustly(const SegmentSignals& signals, const SamplingGrid& grid,
                                         const LeverArm& antenna, const SavitzkyGolay& filter) {
  const auto raw_psi = OntoGrid(signals.psi_rad, grid);
  const auto r_per_row = filter.Slope(raw_psi);
  BodyPath path{OntoGrid(signals.north_m, grid), OntoGrid(signals.east_m, grid)};
  RemoveLeverArm(path, raw_psi, antenna);
  const Increments increments = BodyIncrements(path, raw_psi);
  const auto u_per_row = filter.SlopeOfIncrements(increments.forward_m);
  const auto v_per_row = filter.SlopeOfIncrements(increments.starboard_m);
  const auto filtered = FilterAsVelocity(signals.commands, grid, filter);

  std::vector<PreparedRow> rows = EmptyRows(signals, grid);
  FillPoses(rows, {filter.Smooth(path.x_m), filter.Smooth(path.y_m)}, filter.Smooth(raw_psi));
  for (std::size_t row = 0; row < grid.rows; ++row) {
    rows[row].nu = {u_per_row[row] / grid.period_s, v_per_row[row] / grid.period_s,
                    r_per_row[row] / grid.period_s};
    rows[row].delta = filtered[row];
  }
  return rows;
}

}  // namespace telltale
