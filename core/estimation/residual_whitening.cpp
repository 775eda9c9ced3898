#include "telltale/core/estimation/residual_whitening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace telltale {

ResidualWhitening::ResidualWhitening(std::vector<RowRange> runs,
                                     const Eigen::VectorXd& autocovariance)
    : runs_(std::move(runs)) {
  constexpr double kLeastShare = 1e-6;  // of the variance, below which nothing new is left
  const bool varies = autocovariance.allFinite() && autocovariance[0] > 0.0;
  double variance = varies ? autocovariance[0] : 1.0;
  Eigen::VectorXd weights;
  by_known_.push_back({weights, std::sqrt(variance)});
  if (!varies) return;
  // Levinson and Durbin: with one residual more before it, what that one adds of its own.
  for (Eigen::Index known = 1; known < autocovariance.size(); ++known) {
    const auto nearer = autocovariance.segment(1, known - 1).reverse();
    const double own = (autocovariance[known] - weights.dot(nearer)) / variance;
    variance *= 1.0 - own * own;
    if (!(variance > kLeastShare * autocovariance[0])) return;
    Eigen::VectorXd longer(known);
    longer << weights - own * weights.reverse(), own;
    weights = std::move(longer);
    by_known_.push_back({weights, std::sqrt(variance)});
  }
}

template <typename Visit>
void ResidualWhitening::ForEachStretch(const Visit& visit) const {
  for (const RowRange& run : runs_) {
    const std::size_t few = std::min(by_known_.size() - 1, run.size());
    const auto begin = static_cast<Eigen::Index>(run.begin);
    for (std::size_t known = 0; known < few; ++known) {
      visit(Stretch{begin + static_cast<Eigen::Index>(known), 1, by_known_[known]});
    }
    const auto rest = static_cast<Eigen::Index>(run.size() - few);
    visit(Stretch{begin + static_cast<Eigen::Index>(few), rest, by_known_[few]});
  }
}

Eigen::MatrixXd ResidualWhitening::Whiten(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd white = X;
  ForEachStretch([&](const Stretch& s) {
    auto news = white.middleRows(s.begin, s.size);
    for (Eigen::Index l = 1; l <= s.by.weights.size(); ++l) {
      news -= s.by.weights[l - 1] * X.middleRows(s.begin - l, s.size);
    }
    news /= s.by.deviation;
  });
  return white;
}

Eigen::MatrixXd ResidualWhitening::WhitenBack(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd back = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  ForEachStretch([&](const Stretch& s) {
    const Eigen::MatrixXd news = X.middleRows(s.begin, s.size) / s.by.deviation;
    back.middleRows(s.begin, s.size) += news;
    for (Eigen::Index l = 1; l <= s.by.weights.size(); ++l) {
      back.middleRows(s.begin - l, s.size) -= s.by.weights[l - 1] * news;
    }
  });
  return back;
}

}  // namespace telltale
