#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"

#include <limits>

namespace telltale {

using enum FossenParameter;

FossenPrior PriorOf(const Vehicle& vehicle) {
  const double length =
      vehicle.hull ? vehicle.hull->length_m : 2.0 * vehicle.propeller_separation_m;
  const double square = length * length;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  FossenPrior prior;
  const auto set = [&prior](FossenParameter parameter, double mean, double sigma, double least,
                            double greatest) {
    prior.mean[At(parameter)] = mean;
    prior.standard_deviation[At(parameter)] = sigma;
    prior.least[At(parameter)] = least;
    prior.greatest[At(parameter)] = greatest;
  };
  set(kM22, 1.6, 0.8, 0.7, 5.0);
  set(kM23, 0.0, 0.1 * length, -0.5 * length, 0.5 * length);
  set(kM33, 0.1 * square, 0.1 * square, 0.015 * square, square);
  set(kXu, 0.2, 1.0, 0.0, kNone);
  set(kXuu, 0.5 / length, 1.0 / length, 0.0, kNone);
  set(kYv, 0.5, 1.5, 0.0, kNone);
  set(kYr, 0.0, 0.6 * length, -kNone, kNone);
  set(kNv, 0.0, 0.6 * length, -kNone, kNone);
  set(kNr, 0.1 * square, 0.3 * square, 0.0, kNone);
  set(kYvv, 2.0 / length, 6.0 / length, 0.0, kNone);
  set(kYrv, 0.5, 2.0, 0.0, kNone);
  set(kNvv, 0.0, 0.6, -kNone, kNone);
  set(kNvr, 0.15 * length, 0.6 * length, 0.0, kNone);
  set(kNrr, 0.1 * square, square, 0.0, kNone);
  set(kYuv, 0.3 / length, 2.0 / length, 0.0, kNone);
  set(kYur, 0.0, 2.0, -kNone, kNone);
  set(kNuv, 0.0, 2.0, -kNone, kNone);
  set(kNur, 0.05 * length, 0.2 * length, 0.0, kNone);
  for (const FossenParameter thrust :
       {kForwardLinear, kForwardQuadratic, kReverseLinear, kReverseQuadratic}) {
    set(thrust, 0.5, 3.0, 0.0, kNone);
  }
  set(kReverseLoss, 0.3, 0.2, 0.0, 2.0);
  set(kImbalance, 0.0, 0.1, -0.5, 0.5);
  set(kForwardDeadBand, 0.04, 0.04, 0.0, kWidestDeadZone);
  set(kReverseDeadBand, 0.04, 0.04, 0.0, kWidestDeadZone);
  set(kTimeConstant, 0.2, 0.2, 0.005, 10.0);
  set(kCommandDelay, 0.0, 0.15, -1.0, 1.0);
  set(kFixDelay, 0.1, 0.15, -1.0, 1.0);
  return prior;
}

}  // namespace telltale
