#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"

namespace telltale {

PosteriorPoint EffectPosterior::At(const Eigen::VectorXd& scaled) const {
  PosteriorPoint point;
  point.scaled = scaled;
  point.errors = error_model_(parameters_.Effects(scaled));
  point.whitened = metric_.Whiten(point.errors);
  point.square = metric_.SquaredMahalanobis(point.whitened);
  point.cost = point.square + scaled.cwiseAbs2().dot(parameters_.PriorInformation());
  return point;
}

Eigen::MatrixXd EffectPosterior::Jacobian(const PosteriorPoint& point) const {
  Eigen::MatrixXd jacobian(point.whitened.size(), parameters_.Size());
  for (Eigen::Index i = 0; i < parameters_.Size(); ++i) {
    const double step = parameters_.DerivativeStep(i, point.scaled[i]);
    Eigen::VectorXd moved = point.scaled;
    moved[i] += step;
    jacobian.col(i) =
        (metric_.Whiten(error_model_(parameters_.Effects(moved))) - point.whitened) / step;
  }
  return jacobian;
}

}  // namespace telltale
