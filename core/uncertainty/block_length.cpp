#include "telltale/core/uncertainty/block_length.hpp"

#include <algorithm>
#include <cmath>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

constexpr double kSignificance = 2.0;

/// Autocovariances of one series, each formed when first asked for.
class Correlogram {
 public:
  Correlogram(const double* series, const std::vector<RowRange>& runs, std::size_t rows)
      : series_(series), runs_(runs), rows_(static_cast<double>(rows)) {}

  double operator()(std::size_t lag) {
    while (known_.size() <= lag) known_.push_back(AtLag(known_.size()));
    return known_[lag];
  }

 private:
  double AtLag(std::size_t lag) const {
    double sum = 0.0;
    for (const RowRange& run : runs_) {
      if (run.size() <= lag) continue;
      const auto overlap = static_cast<Eigen::Index>(run.size() - lag);
      const Eigen::Map<const Eigen::VectorXd> early(series_ + run.begin, overlap);
      const Eigen::Map<const Eigen::VectorXd> late(series_ + run.begin + lag, overlap);
      sum += early.dot(late);
    }
    return sum / rows_;
  }

  const double* series_;
  const std::vector<RowRange>& runs_;
  double rows_;
  std::vector<double> known_;
};

/// The smallest m >= 1 after which `quiet` lags in a row are insignificant; the last significant
/// lag where there is none up to `most`.
std::size_t LastSignificantLag(Correlogram& R, double rows, std::size_t quiet, std::size_t most) {
  const double threshold = kSignificance * std::sqrt(std::log10(rows) / rows) * R(0);
  std::size_t last = 0;
  for (std::size_t lag = 1; lag <= most; ++lag) {
    if (std::abs(R(lag)) >= threshold) last = lag;
    if (lag - std::max<std::size_t>(last, 1) >= quiet) break;
  }
  return std::max<std::size_t>(last, 1);
}

/// The trapezoid of height one that is flat up to one half.
double FlatTop(double x) {
  return std::clamp(2.0 * (1.0 - std::abs(x)), 0.0, 1.0);
}

/// (G / g)^2, the squared relative bias of the variance from blocks of length one.
double SquaredBias(Correlogram& R, std::size_t width) {
  double G = 0.0;
  double g = R(0);
  for (std::size_t lag = 1; lag <= width; ++lag) {
    const double k = static_cast<double>(lag);
    const double twice = 2.0 * FlatTop(k / static_cast<double>(width)) * R(lag);
    G += k * twice;
    g += twice;
  }
  return std::pow(G / g, 2);
}

}  // namespace

std::size_t BlockLength(const Eigen::MatrixXd& series, const std::vector<RowRange>& runs) {
  const auto n = static_cast<std::size_t>(series.rows());
  Require(n > 1, "at least two rows");
  const double rows = static_cast<double>(n);
  const auto quiet =
      std::max<std::size_t>(5, static_cast<std::size_t>(std::ceil(std::sqrt(std::log10(rows)))));
  const std::size_t most =
      std::min(n - 1, static_cast<std::size_t>(std::ceil(std::sqrt(rows))) + quiet);
  const double longest = std::max(1.0, std::ceil(std::min(3.0 * std::sqrt(rows), rows / 3.0)));

  double bias = 0.0;
  double counted = 0.0;
  for (Eigen::Index j = 0; j < series.cols(); ++j) {
    Correlogram R(series.col(j).data(), runs, n);
    if (!(R(0) > 0.0)) continue;
    const std::size_t width = std::min(2 * LastSignificantLag(R, rows, quiet, most), most);
    // Beyond what the longest length answers to, a series has no more say.
    bias += std::min(std::pow(longest, 3) / (1.5 * rows), SquaredBias(R, width));
    counted += 1.0;
  }
  if (counted == 0.0) return 1;
  const double length = std::cbrt(1.5 * bias / counted * rows);
  return static_cast<std::size_t>(std::lround(std::clamp(length, 1.0, longest)));
}

}  // namespace telltale
