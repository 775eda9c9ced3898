#include "telltale/core/data/body_path.hpp"

#include <cmath>

namespace telltale {

void RemoveLeverArm(BodyPath& path, std::span<const double> psi, const LeverArm& arm) {
  for (std::size_t row = 0; row < psi.size(); ++row) {
    const double c = std::cos(psi[row]);
    const double s = std::sin(psi[row]);
    path.x_m[row] -= c * arm.forward_m - s * arm.starboard_m;
    path.y_m[row] -= s * arm.forward_m + c * arm.starboard_m;
  }
}

Nu ToBody(double psi, double dx, double dy, double period_s) {
  const double c = std::cos(psi);
  const double s = std::sin(psi);
  return {(c * dx + s * dy) / period_s, (-s * dx + c * dy) / period_s, 0.0};
}

std::vector<PreparedRow> EmptyRows(const SegmentSignals& signals, const SamplingGrid& grid) {
  std::vector<PreparedRow> rows(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const double t = grid.Time(row);
    rows[row].time_s = t;
    rows[row].region = signals.commands.MajorityRegion(t, t + grid.period_s);
  }
  return rows;
}

void FillPoses(std::vector<PreparedRow>& rows, const BodyPath& path, std::span<const double> psi) {
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row].eta = {path.x_m[row], path.y_m[row], psi[row]};
  }
}

}  // namespace telltale
