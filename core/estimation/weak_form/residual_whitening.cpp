#include "telltale/core/estimation/weak_form/residual_whitening.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace telltale {

ResidualWhitening::ResidualWhitening(std::vector<RowRange> runs,
                                     const Eigen::VectorXd& autocovariance)
    : runs_(std::move(runs)) {
  constexpr double kLeastShare = 1e-6;  // of the variance, below which no innovation is left
  const bool varies = autocovariance.allFinite() && autocovariance[0] > 0.0;
  double variance = varies ? autocovariance[0] : 1.0;
  Eigen::VectorXd weights;
  predictors_.push_back({weights, std::sqrt(variance)});
  if (!varies) return;
  // Levinson-Durbin recursion: `own` is the partial autocorrelation at this order.
  for (Eigen::Index order = 1; order < autocovariance.size(); ++order) {
    const auto nearer = autocovariance.segment(1, order - 1).reverse();
    const double own = (autocovariance[order] - weights.dot(nearer)) / variance;
    variance *= 1.0 - own * own;
    if (!(variance > kLeastShare * autocovariance[0])) return;
    Eigen::VectorXd longer(order);
    longer << weights - own * weights.reverse(), own;
    weights = std::move(longer);
    predictors_.push_back({weights, std::sqrt(variance)});
  }
}

template <typename Visit>
void ResidualWhitening::ForEachPredictedRange(const Visit& visit) const {
  for (const RowRange& run : runs_) {
    const std::size_t few = std::min(predictors_.size() - 1, run.size());
    const auto begin = static_cast<Eigen::Index>(run.begin);
    for (std::size_t order = 0; order < few; ++order) {
      visit(PredictedRange{begin + static_cast<Eigen::Index>(order), 1, predictors_[order]});
    }
    const auto rest = static_cast<Eigen::Index>(run.size() - few);
    visit(PredictedRange{begin + static_cast<Eigen::Index>(few), rest, predictors_[few]});
  }
}

Eigen::MatrixXd ResidualWhitening::Whiten(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd white = X;
  ForEachPredictedRange([&](const PredictedRange& s) {
    auto innovations = white.middleRows(s.begin, s.size);
    for (Eigen::Index l = 1; l <= s.by.weights.size(); ++l) {
      innovations -= s.by.weights[l - 1] * X.middleRows(s.begin - l, s.size);
    }
    innovations /= s.by.deviation;
  });
  return white;
}

Eigen::MatrixXd ResidualWhitening::WhitenBack(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd back = Eigen::MatrixXd::Zero(X.rows(), X.cols());
  ForEachPredictedRange([&](const PredictedRange& s) {
    const Eigen::MatrixXd innovations = X.middleRows(s.begin, s.size) / s.by.deviation;
    back.middleRows(s.begin, s.size) += innovations;
    for (Eigen::Index l = 1; l <= s.by.weights.size(); ++l) {
      back.middleRows(s.begin - l, s.size) -= s.by.weights[l - 1] * innovations;
    }
  });
  return back;
}

}  // namespace telltale
