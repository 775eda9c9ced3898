#include "telltale/core/estimation/prediction_error/noise_variation.hpp"

namespace telltale {

void NoiseVariation::Step(const FilterTransition& transition, const FilterState& before) {
  FilterTransition own = transition;
  own.decay = DecayOver(filter_.Noise(), transition.step_s);
  FilterState next;
  next.head<kMovingStates>() = own.Moved(deviation_);
  next.tail<kDecayingStates>() =
      own.decay.cwiseProduct(deviation_.tail<kDecayingStates>()) +
      (own.decay - transition.decay).cwiseProduct(before.tail<kDecayingStates>());
  deviation_ = next;
  filter_.Spread(own);
}

void NoiseVariation::Take(const ScalarReading& reading, const FilterGain& gain, double time_s) {
  ScalarReading own = reading;
  own.innovation -= ReadBy(reading.row, deviation_)[0];
  const FilterGain own_gain = filter_.Take(own);
  innovations_.push_back({time_s, own.innovation, own_gain.variance});
  deviation_ += own_gain.gain * own.innovation - gain.gain * reading.innovation;
}

}  // namespace telltale
