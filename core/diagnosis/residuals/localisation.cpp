#include "telltale/core/diagnosis/residuals/localisation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/diagnosis/residuals/acceleration_residuals.hpp"
#include "telltale/core/diagnosis/residuals/operating_conditions.hpp"

namespace telltale {
namespace {

constexpr const LocalisationConstants& kLimits = kDiagnosis.localisation;

struct CellStatistics {
  double mean = 0.0;
  double square = 0.0;
  double count = 0.0;
};

CellStatistics StatisticsIn(const OperatingCondition& condition,
                            const std::vector<AccelerationResidual>& residuals,
                            std::size_t channel) {
  CellStatistics statistics;
  for (const AccelerationResidual& residual : residuals) {
    if (!condition.holds(residual)) continue;
    statistics.mean += residual.error[channel];
    statistics.square += residual.error[channel] * residual.error[channel];
    statistics.count += 1.0;
  }
  if (statistics.count > 0.0) {
    statistics.mean /= statistics.count;
    statistics.square /= statistics.count;
  }
  return statistics;
}

/// A cell under test.
struct Cell {
  GapCell listed;
  double rows = 0.0;
  std::vector<double> sums;  ///< by cluster, deviations from the mean of the references
  double statistic = 0.0;    ///< |sum of sums| over their root sum of squares
};

/// Share of the excess per row.
double DensityOf(const Cell& cell) {
  return cell.listed.excess_share / cell.rows;
}

/// A region at one speed lies within that region, and within that speed.
bool LiesWithin(const GapCell& inner, const GapCell& outer) {
  if (inner.channel != outer.channel || !inner.region || inner.bin.empty()) return false;
  return outer.region ? outer.region == inner.region && outer.bin.empty() : outer.bin == inner.bin;
}

/// |sum of signs * sums| over the root sum of squares.
double SignedStatistic(const std::vector<double>& sums, const std::vector<double>& signs) {
  double norm = 0.0;
  double total = 0.0;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    total += signs[c] * sums[c];
    norm += sums[c] * sums[c];
  }
  return std::abs(total) / std::sqrt(norm);
}

/// Theil's decomposition of the mean square: the part of its mean (bias) and the part that is
/// proportional to the model's own output (slope).
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
  if (bias >= slope && bias > kLimits.bias_share * excess) return GapKind::kBias;
  if (slope > kLimits.slope_share * excess) return GapKind::kSlope;
  return bias + slope > kLimits.timing_share * excess ? GapKind::kTiming : GapKind::kNoise;
}

/// Residuals of one channel: of the recording, and of the references as what is nominal.
class ChannelResiduals {
 public:
  ChannelResiduals(const std::vector<AccelerationResidual>& residuals,
                   const std::vector<AccelerationResidual>& nominal,
                   const OperatingCondition& everywhere, std::size_t channel, std::size_t clusters)
      : residuals_(residuals), nominal_(nominal), channel_(channel), clusters_(clusters) {
    overall_ = StatisticsIn(everywhere, nominal, channel);
    const CellStatistics now = StatisticsIn(everywhere, residuals, channel);
    excess_ = (now.square - overall_.square) * now.count;
  }

  /// None where the condition holds in too few clusters, or the channel has no excess.
  std::optional<Cell> CellIn(const OperatingCondition& condition) const {
    CellStatistics nominal = StatisticsIn(condition, nominal_, channel_);
    if (nominal.count < 1.0) nominal = {0.0, overall_.square, 0.0};
    std::vector<double> sums(clusters_);
    std::vector<bool> met(clusters_);
    double count = 0.0, square = 0.0, sum = 0.0;
    for (const AccelerationResidual& residual : residuals_) {
      if (!condition.holds(residual)) continue;
      sums[residual.cluster] += residual.error[channel_] - nominal.mean;
      met[residual.cluster] = true;
      count += 1.0;
      sum += residual.error[channel_];
      square += residual.error[channel_] * residual.error[channel_];
    }
    const auto windows = static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
    if (windows < kLimits.minimum_clusters || excess_ <= 0.0) return std::nullopt;
    Cell cell;
    cell.statistic = SignedStatistic(sums, std::vector<double>(sums.size(), 1.0));
    cell.sums = std::move(sums);
    cell.rows = count;
    cell.listed.channel = kEquations[channel_];
    cell.listed.region = condition.region;
    cell.listed.bin = condition.bin;
    cell.listed.excess_share = std::clamp((square - count * nominal.square) / excess_, 0.0, 1.0);
    cell.listed.mean = (sum / count - nominal.mean) / std::sqrt(overall_.square);
    cell.listed.windows = windows;
    cell.listed.kind = KindOf(condition, residuals_, channel_, nominal);
    return cell;
  }

 private:
  const std::vector<AccelerationResidual>& residuals_;
  const std::vector<AccelerationResidual>& nominal_;
  std::size_t channel_;
  std::size_t clusters_;
  CellStatistics overall_;
  double excess_ = 0.0;
};

std::vector<Cell> CellsOf(const std::vector<AccelerationResidual>& residuals,
                          const std::vector<AccelerationResidual>& nominal) {
  const std::vector<OperatingCondition> conditions = OperatingConditions();
  std::size_t clusters = 0;
  for (const AccelerationResidual& residual : residuals)
    clusters = std::max(clusters, residual.cluster + 1);
  std::vector<Cell> cells;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const ChannelResiduals of_channel(residuals, nominal, conditions.front(), channel, clusters);
    for (const OperatingCondition& condition : conditions) {
      if (auto cell = of_channel.CellIn(condition)) cells.push_back(*std::move(cell));
    }
  }
  return cells;
}

/// The largest statistic of all cells in each replicate, whose clusters have random signs.
std::vector<double> LargestUnderRandomSigns(const std::vector<Cell>& cells, std::uint64_t seed) {
  RandomEngine engine(seed);
  std::vector<double> largest;
  std::vector<double> signs(cells.empty() ? 0 : cells.front().sums.size());
  for (std::size_t i = 0; i < kLimits.replicates; ++i) {
    for (double& sign : signs) sign = DrawBelow(engine, 2) == 0 ? -1.0 : 1.0;
    double most = 0.0;
    for (const Cell& cell : cells) most = std::max(most, SignedStatistic(cell.sums, signs));
    largest.push_back(most);
  }
  return largest;
}

/// The cells with a p-value that is small enough and a share of the excess that is large enough.
std::vector<Cell> SignificantOf(std::vector<Cell> cells, const std::vector<double>& largest) {
  std::vector<Cell> found;
  for (Cell& cell : cells) {
    const auto above = std::count_if(largest.begin(), largest.end(),
                                     [&](double most) { return most >= cell.statistic; });
    cell.listed.p_value =
        (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(largest.size()));
    const bool significant = cell.listed.p_value <= kLimits.significance;
    if (!significant || cell.listed.excess_share < kLimits.material_share) continue;
    found.push_back(std::move(cell));
  }
  return found;
}

/// Without nested cells whose rows hold little more than those of the wider cell; largest first.
std::vector<GapCell> WithoutRedundant(const std::vector<Cell>& found) {
  std::vector<GapCell> listed;
  for (const Cell& cell : found) {
    const bool redundant = std::ranges::any_of(found, [&](const Cell& wider) {
      return LiesWithin(cell.listed, wider.listed) &&
             DensityOf(cell) < kLimits.density_ratio * DensityOf(wider);
    });
    if (!redundant) listed.push_back(cell.listed);
  }
  std::stable_sort(listed.begin(), listed.end(), [](const GapCell& a, const GapCell& b) {
    return a.excess_share > b.excess_share;
  });
  return listed;
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
  const std::vector<Cell> cells = CellsOf(residuals, nominal);
  return WithoutRedundant(SignificantOf(cells, LargestUnderRandomSigns(cells, seed)));
}

}  // namespace telltale
