#include "telltale/core/diagnosis/hypotheses/effect_posterior.hpp"

#include <algorithm>

namespace telltale {

double EffectPosterior::ScaleOf(const PosteriorPoint& point) const {
  // Errors that an effect explains to rounding have no scale.
  constexpr double kLeastShare = 1e-12;
  return std::max(point.square, kLeastShare * metric_.ExpectedSquare());
}

PosteriorPoint EffectPosterior::At(const Eigen::VectorXd& scaled) const {
  PosteriorPoint point;
  point.scaled = scaled;
  point.errors = error_model_(parameters_.Effects(scaled));
  point.whitened = metric_.Whiten(point.errors);
  point.square = metric_.SquaredMahalanobis(point.whitened);
  point.cost = metric_.Deviance(ScaleOf(point), metric_.ExpectedSquare()) +
               scaled.cwiseAbs2().dot(parameters_.PriorInformation());
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

Eigen::MatrixXd EffectPosterior::Information(const PosteriorPoint& point,
                                             const Eigen::MatrixXd& jacobian,
                                             const Eigen::MatrixXd& marginalised) const {
  Eigen::MatrixXd information = Precision(point) * jacobian.transpose() * marginalised;
  information.diagonal() += parameters_.PriorInformation();
  return information;
}

Eigen::VectorXd EffectPosterior::Gradient(const PosteriorPoint& point,
                                          const Eigen::MatrixXd& marginalised) const {
  return Precision(point) * marginalised.transpose() * point.whitened +
         parameters_.PriorInformation().cwiseProduct(point.scaled);
}

}  // namespace telltale
