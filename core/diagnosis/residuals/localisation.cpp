#include "telltale/core/diagnosis/residuals/localisation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/effects/augmented_boat.hpp"
#include "telltale/core/vessel/compass.hpp"

namespace telltale {
namespace {

constexpr double kClusterS = 5.0;
constexpr double kAfterStepS = 1.0;
constexpr double kStep = 0.1;  // of full command: a change that counts as a step
constexpr std::size_t kReplicates = 500;
constexpr double kSignificant = 0.05;
constexpr double kMaterialShare = 0.05;
// A corner within a corner says more where its rows hold half as much excess again each.
constexpr double kDensityRatio = 1.5;
constexpr std::size_t kMinimumClusters = 6;
constexpr std::array kSpeedEdges = {0.5, 1.0, 1.5};

/// One row's miss and what it went through.
struct AccelerationResidual {
  std::array<double, 3> error{};      ///< m/s^2, m/s^2, rad/s^2
  std::array<double, 3> predicted{};  ///< likewise, what the model does
  std::size_t cluster = 0;
  PropellerRegion region = PropellerRegion::kFF;
  std::size_t speed = 0;
  std::size_t octant = 0;
  std::size_t third = 0;
  bool after_step = false;
};

std::size_t SpeedBin(double speed_m_s) {
  return static_cast<std::size_t>(
      std::upper_bound(kSpeedEdges.begin(), kSpeedEdges.end(), speed_m_s) - kSpeedEdges.begin());
}

std::string SpeedName(std::size_t bin) {
  const auto text = [&](double value) {
    return std::to_string(static_cast<int>(value)) +
           (value - std::floor(value) > 0.0 ? ".5" : ".0");
  };
  if (bin == 0) return "below " + text(kSpeedEdges.front()) + " m/s";
  if (bin == kSpeedEdges.size()) return "above " + text(kSpeedEdges.back()) + " m/s";
  return text(kSpeedEdges[bin - 1]) + " to " + text(kSpeedEdges[bin]) + " m/s";
}

bool JustStepped(const HeldCommands& commands, double time_s) {
  const PropellerCommand now = commands.At(time_s);
  const PropellerCommand then = commands.At(time_s - kAfterStepS);
  return std::abs(now.port - then.port) > kStep || std::abs(now.starboard - then.starboard) > kStep;
}

std::vector<AccelerationResidual> AccelerationResidualsOf(const PreparedDataset& dataset,
                                                          const AugmentedModel& augmented) {
  const double h = dataset.sampling_period_s;
  const double span_s = std::max(dataset.EndTime() - dataset.StartTime(), 1.0);
  const AugmentedBoat boat(augmented, dataset.StartTime(), span_s, dataset.hull);
  const std::size_t steps = StepsPerRow(augmented.model, h);
  const double step_s = h / static_cast<double>(steps);
  std::vector<AccelerationResidual> residuals;
  for (std::size_t s = 0; s < dataset.segments.size(); ++s) {
    const RowRange& segment = dataset.segments[s];
    if (segment.size() < 2) continue;
    const double from_s = dataset.rows[segment.begin].time_s;
    const auto drives =
        boat.DrivesAlong(dataset.commands[s], from_s, step_s, segment.size() * steps);
    for (std::size_t k = segment.begin; k + 1 < segment.end; ++k) {
      const PreparedRow& row = dataset.rows[k];
      const auto ahead = std::span(drives).subspan((k - segment.begin) * steps, steps);
      const Nu predicted = boat.Simulate({row.eta, row.nu}, ahead, row.time_s, step_s).back().nu;
      const Nu& next = dataset.rows[k + 1].nu;
      AccelerationResidual residual;
      residual.error = {(next.u - predicted.u) / h, (next.v - predicted.v) / h,
                        (next.r - predicted.r) / h};
      residual.predicted = {(predicted.u - row.nu.u) / h, (predicted.v - row.nu.v) / h,
                            (predicted.r - row.nu.r) / h};
      const double since_s = row.time_s - dataset.StartTime();
      residual.cluster = static_cast<std::size_t>(since_s / kClusterS);
      residual.region = row.region;
      residual.speed = SpeedBin(std::hypot(row.nu.u, row.nu.v));
      residual.octant = NearestCompassPoint(row.eta.psi_rad);
      residual.third = std::min<std::size_t>(static_cast<std::size_t>(3.0 * since_s / span_s), 2);
      residual.after_step = JustStepped(dataset.commands[s], row.time_s);
      residuals.push_back(residual);
    }
  }
  return residuals;
}

/// A corner: which misses lie in it, and its name.
struct OperatingCondition {
  std::optional<PropellerRegion> region;
  std::string bin;
  std::function<bool(const AccelerationResidual&)> holds;
};

std::vector<OperatingCondition> OperatingConditions() {
  std::vector<OperatingCondition> conditions;
  conditions.push_back({std::nullopt, "", [](const AccelerationResidual&) { return true; }});
  for (const PropellerRegion region : kPropellerRegions) {
    conditions.push_back(
        {region, "", [region](const AccelerationResidual& m) { return m.region == region; }});
    for (std::size_t bin = 0; bin <= kSpeedEdges.size(); ++bin) {
      conditions.push_back({region, SpeedName(bin), [region, bin](const AccelerationResidual& m) {
                              return m.region == region && m.speed == bin;
                            }});
    }
  }
  for (std::size_t bin = 0; bin <= kSpeedEdges.size(); ++bin) {
    conditions.push_back({std::nullopt, SpeedName(bin),
                          [bin](const AccelerationResidual& m) { return m.speed == bin; }});
  }
  for (std::size_t point = 0; point < kCompassPoints.size(); ++point) {
    conditions.push_back({std::nullopt, "heading " + std::string(kCompassPoints[point]),
                          [point](const AccelerationResidual& m) { return m.octant == point; }});
  }
  constexpr std::array<std::string_view, 3> kThirds = {"first third", "middle third", "last third"};
  for (std::size_t third = 0; third < kThirds.size(); ++third) {
    conditions.push_back({std::nullopt, std::string(kThirds[third]),
                          [third](const AccelerationResidual& m) { return m.third == third; }});
  }
  conditions.push_back(
      {std::nullopt, "after a step", [](const AccelerationResidual& m) { return m.after_step; }});
  conditions.push_back({std::nullopt, "steady commands",
                        [](const AccelerationResidual& m) { return !m.after_step; }});
  return conditions;
}

struct CellStatistics {
  double mean = 0.0;
  double square = 0.0;
  double count = 0.0;
};

CellStatistics StatisticsIn(const OperatingCondition& condition,
                            const std::vector<AccelerationResidual>& residuals,
                            std::size_t channel) {
  CellStatistics nominal_statistics;
  for (const AccelerationResidual& residual : residuals) {
    if (!condition.holds(residual)) continue;
    nominal_statistics.mean += residual.error[channel];
    nominal_statistics.square += residual.error[channel] * residual.error[channel];
    nominal_statistics.count += 1.0;
  }
  if (nominal_statistics.count > 0.0) {
    nominal_statistics.mean /= nominal_statistics.count;
    nominal_statistics.square /= nominal_statistics.count;
  }
  return nominal_statistics;
}

/// A cell under test: sums of deviations from the usual, by cluster.
struct Cell {
  GapCell listed;
  double rows = 0.0;
  std::vector<double> sums;
  double statistic = 0.0;
};

/// Excess by row, as a share of all of it.
double DensityOf(const Cell& cell) {
  return cell.listed.excess_share / cell.rows;
}

/// A region at one speed lies within that region, and within that speed.
bool LiesWithin(const GapCell& inner, const GapCell& outer) {
  if (inner.channel != outer.channel || !inner.region || inner.bin.empty()) return false;
  return outer.region ? outer.region == inner.region && outer.bin.empty() : outer.bin == inner.bin;
}

/// Theil: how much of the mean square is its mean, how much goes with the model's own output.
GapKind KindOf(const OperatingCondition& condition,
               const std::vector<AccelerationResidual>& residuals, std::size_t channel,
               const CellStatistics& nominal_statistics) {
  double n = 0.0, e = 0.0, p = 0.0, ee = 0.0, pp = 0.0, ep = 0.0;
  for (const AccelerationResidual& residual : residuals) {
    if (!condition.holds(residual)) continue;
    const double error = residual.error[channel] - nominal_statistics.mean;
    const double predicted = residual.predicted[channel];
    n += 1.0, e += error, p += predicted;
    ee += error * error, pp += predicted * predicted, ep += error * predicted;
  }
  e /= n, p /= n, ee /= n, pp /= n, ep /= n;
  const double spread = pp - p * p;
  const double bias = e * e;
  const double slope = spread > 0.0 ? (ep - e * p) * (ep - e * p) / spread : 0.0;
  const double excess = std::max(
      ee - nominal_statistics.square + nominal_statistics.mean * nominal_statistics.mean, 0.0);
  if (bias >= slope && bias > 0.3 * excess) return GapKind::kBias;
  if (slope > 0.3 * excess) return GapKind::kSlope;
  return bias + slope > 0.1 * excess ? GapKind::kTiming : GapKind::kNoise;
}

}  // namespace

std::vector<GapCell> Localise(const PreparedDataset& recording,
                              const std::vector<PreparedDataset>& references,
                              const AugmentedModel& boat, std::uint64_t seed) {
  Require(!references.empty(), "at least one reference");
  const std::vector<AccelerationResidual> residuals = AccelerationResidualsOf(recording, boat);
  std::vector<AccelerationResidual> nominal;
  for (const PreparedDataset& reference : references) {
    const auto more = AccelerationResidualsOf(reference, boat);
    nominal.insert(nominal.end(), more.begin(), more.end());
  }
  if (residuals.empty() || nominal.empty()) return {};
  const std::vector<OperatingCondition> conditions = OperatingConditions();
  std::size_t clusters = 0;
  for (const AccelerationResidual& residual : residuals)
    clusters = std::max(clusters, residual.cluster + 1);

  std::vector<Cell> cells;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const CellStatistics overall = StatisticsIn(conditions.front(), nominal, channel);
    const CellStatistics now = StatisticsIn(conditions.front(), residuals, channel);
    const double sigma = std::sqrt(overall.square);
    const double excess = (now.square - overall.square) * now.count;
    for (const OperatingCondition& condition : conditions) {
      CellStatistics nominal_statistics = StatisticsIn(condition, nominal, channel);
      if (nominal_statistics.count < 1.0) nominal_statistics = {0.0, overall.square, 0.0};
      std::vector<double> sums(clusters);
      std::vector<bool> met(clusters);
      double count = 0.0, square = 0.0, sum = 0.0;
      for (const AccelerationResidual& residual : residuals) {
        if (!condition.holds(residual)) continue;
        sums[residual.cluster] += residual.error[channel] - nominal_statistics.mean;
        met[residual.cluster] = true;
        count += 1.0;
        sum += residual.error[channel];
        square += residual.error[channel] * residual.error[channel];
      }
      const auto windows = static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
      if (windows < kMinimumClusters || excess <= 0.0) continue;
      double norm = 0.0;
      double total = 0.0;
      for (const double part : sums) {
        norm += part * part;
        total += part;
      }
      Cell cell;
      cell.statistic = std::abs(total) / std::sqrt(norm);
      cell.sums = std::move(sums);
      cell.rows = count;
      cell.listed.channel = kEquations[channel];
      cell.listed.region = condition.region;
      cell.listed.bin = condition.bin;
      cell.listed.excess_share =
          std::clamp((square - count * nominal_statistics.square) / excess, 0.0, 1.0);
      cell.listed.mean = (sum / count - nominal_statistics.mean) / sigma;
      cell.listed.windows = windows;
      cell.listed.kind = KindOf(condition, residuals, channel, nominal_statistics);
      cells.push_back(std::move(cell));
    }
  }

  RandomEngine engine(seed);
  std::vector<double> largest;
  std::vector<double> signs(clusters);
  for (std::size_t i = 0; i < kReplicates; ++i) {
    for (double& sign : signs) sign = DrawBelow(engine, 2) == 0 ? -1.0 : 1.0;
    double most = 0.0;
    for (const Cell& cell : cells) {
      double norm = 0.0;
      double total = 0.0;
      for (std::size_t c = 0; c < clusters; ++c) {
        total += signs[c] * cell.sums[c];
        norm += cell.sums[c] * cell.sums[c];
      }
      most = std::max(most, std::abs(total) / std::sqrt(norm));
    }
    largest.push_back(most);
  }
  std::vector<Cell> found;
  for (Cell& cell : cells) {
    const auto above = std::count_if(largest.begin(), largest.end(),
                                     [&](double most) { return most >= cell.statistic; });
    cell.listed.p_value =
        (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(kReplicates));
    if (cell.listed.p_value > kSignificant || cell.listed.excess_share < kMaterialShare) continue;
    found.push_back(std::move(cell));
  }
  std::vector<GapCell> listed;
  for (const Cell& cell : found) {
    const bool redundant = std::ranges::any_of(found, [&](const Cell& wider) {
      return LiesWithin(cell.listed, wider.listed) &&
             DensityOf(cell) < kDensityRatio * DensityOf(wider);
    });
    if (!redundant) listed.push_back(cell.listed);
  }
  std::stable_sort(listed.begin(), listed.end(), [](const GapCell& a, const GapCell& b) {
    return a.excess_share > b.excess_share;
  });
  return listed;
}

}  // namespace telltale
