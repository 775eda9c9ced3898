#include "telltale/core/identification/physical_range.hpp"

#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"

namespace telltale {

FossenVector PhysicalRange::Within(const FossenVector& parameters) const {
  return WithPositiveMass(parameters.cwiseMax(least).cwiseMin(greatest));
}

PhysicalRange RangeOf(const PhysicalModel& model) {
  Vehicle vehicle;
  vehicle.propeller_separation_m = model.propeller_separation_m;
  const FossenPrior prior = PriorOf(vehicle);
  const FossenVector estimates = model.Estimates();
  return {prior.least.cwiseMin(estimates), prior.greatest.cwiseMax(estimates)};
}

}  // namespace telltale
