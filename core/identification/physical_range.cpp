#include "telltale/core/identification/physical_range.hpp"

#include <algorithm>
#include <cstddef>

#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"

namespace telltale {

using enum FossenParameter;

FossenVector PhysicalRange::Within(const FossenVector& parameters) const {
  return WithPositiveMass(parameters.cwiseMax(least).cwiseMin(greatest));
}

PhysicalRange RangeOf(const PhysicalModel& model) {
  Vehicle vehicle;
  vehicle.propeller_separation_m = model.propeller_separation_m;
  const FossenPrior prior = PriorOf(vehicle);
  const FossenVector estimates = model.Estimates();
  PhysicalRange range{prior.least.cwiseMin(estimates), prior.greatest.cwiseMax(estimates)};
  const auto interval_of = [&](FossenParameter parameter) {
    return model.parameters[static_cast<std::size_t>(At(parameter))].interval;
  };
  // What a longer hull can have lies within their intervals.
  double& least_m23 = range.least[At(kM23)];
  least_m23 = std::min(least_m23, interval_of(kM23).lower);
  for (const FossenParameter parameter : {kM23, kM33}) {
    double& greatest = range.greatest[At(parameter)];
    greatest = std::max(greatest, interval_of(parameter).upper);
  }
  return range;
}

}  // namespace telltale
