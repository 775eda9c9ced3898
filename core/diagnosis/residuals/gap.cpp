#include "telltale/core/diagnosis/residuals/gap.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <boost/random/normal_distribution.hpp>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/random.hpp"
#include "telltale/core/diagnosis/diagnosis_constants.hpp"
#include "telltale/core/uncertainty/distributions.hpp"
#include "telltale/core/uncertainty/interval.hpp"

namespace telltale {
namespace {

// A window that errs by more root mean square sigmas than this counts as erring by so many.
constexpr double kMaximumSigmas = kDiagnosis.gap.largest_sigmas;
constexpr double kBlockS = kDiagnosis.gap.block_s;
constexpr std::size_t kResamples = kDiagnosis.gap.resamples;
constexpr double kLevel = kDiagnosis.gap.level;
// Of ln G^2 from one nominal day to another where a single recording cannot show it.
constexpr double kDefaultSpread = kDiagnosis.gap.single_recording_sd;
// Nominal days differ by this at least, even where the few references agree.
constexpr double kMinimumSpread = kDiagnosis.gap.minimum_sd;

double SpreadWithin(const Eigen::VectorXd& gaps, const std::vector<std::size_t>& blocks) {
  const auto sums = SumsByBlock(gaps, Eigen::VectorXd::Ones(gaps.size()), blocks);
  if (sums.size() < 2) return 1.0;
  const double mean = gaps.mean();
  double square = 0.0;
  for (const auto& [sum, count] : sums) {
    const double off = sum - mean * count;
    square += off * off;
  }
  return std::sqrt(square) / (mean * static_cast<double>(gaps.size()));
}

double MeanOf(const std::vector<std::array<double, 4>>& values, int channel) {
  double sum = 0.0;
  for (const auto& value : values) sum += value[static_cast<std::size_t>(channel)];
  return sum / static_cast<double>(values.size());
}

/// What further days stay below in G^2 at this level, given ln G^2 of so many.
double LimitOfOneMoreDay(double mean_log, double spread, double days, double level) {
  const double quantile = StudentQuantile(std::max(days - 1.0, 2.0), level);
  return std::exp(mean_log + quantile * spread * std::sqrt(1.0 + 1.0 / days));
}

}  // namespace

double NoiseFloor::Squared(int channel) const {
  return std::exp(MeanOf(log_gaps, channel));
}

double NoiseFloor::SquaredLimit(int channel) const {
  return LimitOfOneMoreDay(MeanOf(log_gaps, channel), spread[static_cast<std::size_t>(channel)],
                           static_cast<double>(log_gaps.size()), kLevel);
}

NoiseFloor NoiseFloorOf(const std::vector<FreeRuns>& recordings, const AugmentedModel& boat) {
  std::vector<Eigen::MatrixXd> errors;
  std::vector<std::vector<std::size_t>> blocks;
  for (const FreeRuns& runs : recordings) {
    errors.push_back(runs.Errors(boat));
    blocks.push_back(BlocksOf(runs));
  }
  return NoiseFloorOf(errors, blocks);
}

NoiseFloor NoiseFloorOf(const std::vector<Eigen::MatrixXd>& errors,
                        const std::vector<std::vector<std::size_t>>& blocks) {
  Require(!errors.empty(), "at least one nominal recording");
  Eigen::VectorXd square = Eigen::VectorXd::Zero(errors.front().rows());
  double windows = 0.0;
  for (const Eigen::MatrixXd& day : errors) {
    square += day.rowwise().squaredNorm();
    windows += static_cast<double>(day.cols());
  }
  NoiseFloor floor;
  floor.scale = (square / windows).cwiseSqrt().cwiseMax(1e-9);
  std::array<double, 4> within{};
  for (std::size_t day = 0; day < errors.size(); ++day) {
    auto& log_gap = floor.log_gaps.emplace_back();
    for (int channel = 0; channel <= kAllChannels; ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      const Eigen::VectorXd gaps = SquaredGaps(errors[day], floor.scale, channel);
      log_gap[c] = std::log(gaps.mean());
      within[c] += SpreadWithin(gaps, blocks[day]);
    }
  }
  const double days = static_cast<double>(errors.size());
  for (int channel = 0; channel <= kAllChannels; ++channel) {
    const auto c = static_cast<std::size_t>(channel);
    const double mean = MeanOf(floor.log_gaps, channel);
    double square_spread = days < 2.0 ? kDefaultSpread * kDefaultSpread : 0.0;
    for (const auto& log_gap : floor.log_gaps) {
      square_spread += (log_gap[c] - mean) * (log_gap[c] - mean) / std::max(days - 1.0, 1.0);
    }
    floor.spread[c] = std::max({std::sqrt(square_spread), within[c] / days, kMinimumSpread});
  }
  return floor;
}

Eigen::VectorXd SquaredGaps(const Eigen::MatrixXd& errors, const Eigen::VectorXd& scale,
                            int channel) {
  const Eigen::MatrixXd squares =
      (scale.cwiseInverse().asDiagonal() * errors).cwiseMin(1e6).cwiseMax(-1e6).cwiseAbs2();
  Eigen::VectorXd gaps = Eigen::VectorXd::Zero(errors.cols());
  const Eigen::Index step = channel == kAllChannels ? 1 : 3;
  const Eigen::Index first = channel == kAllChannels ? 0 : channel;
  for (Eigen::Index i = first; i < errors.rows(); i += step) gaps += squares.row(i).transpose();
  const Eigen::Index channel_rows = errors.rows() / step;
  gaps /= static_cast<double>(channel_rows);
  return gaps.cwiseMin(kMaximumSigmas * kMaximumSigmas);
}

double SquaredLimitOfDays(const std::vector<double>& squared_gaps) {
  Require(squared_gaps.size() > 1, "two days or more");
  const auto days = static_cast<double>(squared_gaps.size());
  double mean = 0.0;
  for (const double gap : squared_gaps) mean += std::log(gap) / days;
  double variance = 0.0;
  for (const double gap : squared_gaps)
    variance += std::pow(std::log(gap) - mean, 2) / (days - 1.0);
  return LimitOfOneMoreDay(mean, std::max(std::sqrt(variance), kMinimumSpread), days,
                           kDiagnosis.gap.left_out_level);
}

std::vector<std::size_t> BlocksOf(const FreeRuns& runs) {
  std::vector<std::size_t> blocks;
  const double start_s = runs.Windows() > 0 ? runs.Of(0).time_s : 0.0;
  for (std::size_t w = 0; w < runs.Windows(); ++w) {
    blocks.push_back(static_cast<std::size_t>((runs.Of(w).time_s - start_s) / kBlockS));
  }
  return blocks;
}

std::vector<std::array<double, 2>> SumsByBlock(const Eigen::VectorXd& one,
                                               const Eigen::VectorXd& other,
                                               const std::vector<std::size_t>& blocks) {
  std::map<std::size_t, std::array<double, 2>> sums;
  for (Eigen::Index w = 0; w < one.size(); ++w) {
    auto& sum = sums[blocks[static_cast<std::size_t>(w)]];
    sum[0] += one[w];
    sum[1] += other[w];
  }
  std::vector<std::array<double, 2>> all;
  for (const auto& [block, sum] : sums) all.push_back(sum);
  return all;
}

double UpperBound(const Eigen::VectorXd& squared_gaps, const std::vector<std::size_t>& blocks,
                  std::uint64_t seed) {
  const auto sums = SumsByBlock(squared_gaps, squared_gaps, blocks);
  RandomEngine engine(seed);
  std::vector<double> means;
  for (std::size_t i = 0; i < kResamples; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < sums.size(); ++k) sum += sums[DrawBelow(engine, sums.size())][0];
    means.push_back(sum / static_cast<double>(squared_gaps.size()));
  }
  const auto upper = means.begin() + static_cast<std::ptrdiff_t>(kLevel * kResamples);
  std::nth_element(means.begin(), upper, means.end());
  return *upper;
}

std::optional<ExcessExplained> ExcessExplainedBy(const Eigen::VectorXd& before,
                                                 const Eigen::VectorXd& after,
                                                 const std::vector<std::size_t>& blocks,
                                                 const NoiseFloor& floor, int channel,
                                                 std::uint64_t seed) {
  const double nominal = floor.Squared(channel);
  if (before.size() == 0 || before.mean() <= floor.SquaredLimit(channel)) return std::nullopt;
  const auto sums = SumsByBlock(before, after, blocks);
  RandomEngine engine(seed);
  boost::random::normal_distribution<double> normal;
  const double floor_spread = floor.spread[static_cast<std::size_t>(channel)] /
                              std::sqrt(static_cast<double>(floor.log_gaps.size()));
  const double count = static_cast<double>(before.size());
  std::vector<double> shares;
  for (std::size_t i = 0; i < kResamples; ++i) {
    double b = 0.0;
    double a = 0.0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const auto& sum = sums[DrawBelow(engine, sums.size())];
      b += sum[0] / count;
      a += sum[1] / count;
    }
    const double n = nominal * std::exp(floor_spread * normal(engine));
    if (b > n) shares.push_back((b - a) / (b - n));
  }
  ExcessExplained excess_explained;
  excess_explained.share = (before.mean() - after.mean()) / (before.mean() - nominal);
  excess_explained.interval =
      shares.size() < 2 ? Unbounded(kLevel) : PercentileInterval(shares, kLevel);
  return excess_explained;
}

}  // namespace telltale
