#include "telltale/core/data/paper_preset.hpp"

#include <algorithm>
#include <span>

#include "telltale/core/data/body_path.hpp"

namespace telltale {
namespace {

// Central differences per sample, one-sided at the ends.
std::vector<double> Differentiate(std::span<const double> series) {
  std::vector<double> slope(series.size());
  for (std::size_t row = 0; row < series.size(); ++row) {
    const std::size_t before = row == 0 ? 0 : row - 1;
    const std::size_t after = std::min(row + 1, series.size() - 1);
    slope[row] = (series[after] - series[before]) / static_cast<double>(after - before);
  }
  return slope;
}

TimeSeries CommandSeries(const HeldCommands& commands, double PropellerCommand::*side) {
  TimeSeries series{commands.Times(), {}};
  for (const PropellerCommand& command : commands.Commands()) {
    series.values.push_back(command.*side);
  }
  return series;
}

void FillExtrapolatedCommands(std::vector<PreparedRow>& rows, const HeldCommands& commands) {
  constexpr std::size_t kCubic = 3;
  for (const auto side : {&PropellerCommand::port, &PropellerCommand::starboard}) {
    const TimeSeries series = CommandSeries(commands, side);
    for (PreparedRow& row : rows) {
      row.delta.*side = std::clamp(series.Extrapolate(row.time_s, kCubic), -1.0, 1.0);
    }
  }
}

}  // namespace

std::vector<PreparedRow> PrepareAsPaper(const SegmentSignals& signals, const SamplingGrid& grid,
                                        const LeverArm& antenna, const SavitzkyGolay& filter) {
  const auto cubic = [](const TimeSeries& series) {
    return [&series](double t) { return series.Extrapolate(t, 3); };
  };
  const auto psi = grid.Map([&](double t) { return signals.psi_rad.Extrapolate(t, 8); });
  BodyPath path{grid.Map(cubic(signals.north_m)), grid.Map(cubic(signals.east_m))};
  RemoveLeverArm(path, psi, antenna);

  const auto x_slope = Differentiate(path.x_m);
  const auto y_slope = Differentiate(path.y_m);
  const auto r_per_row = filter.Smooth(Differentiate(psi));
  std::vector<double> u(grid.rows);
  std::vector<double> v(grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    const Nu body = ToBody(psi[row], x_slope[row], y_slope[row], grid.period_s);
    u[row] = body.u;
    v[row] = body.v;
  }
  u = filter.Smooth(u);
  v = filter.Smooth(v);

  std::vector<PreparedRow> rows = EmptyRows(signals, grid);
  FillPoses(rows, path, psi);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    rows[row].nu = {u[row], v[row], r_per_row[row] / grid.period_s};
  }
  FillExtrapolatedCommands(rows, signals.commands);
  return rows;
}

}  // namespace telltale
