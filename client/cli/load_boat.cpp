#include "telltale/client/cli/load_boat.hpp"

#include "telltale/core/base/degrees.hpp"
#include "telltale/core/estimation/prediction_error/fossen_prior.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {
namespace {

constexpr double kShortestHoldS = 2.0;
constexpr double kLongestHoldS = 8.0;
constexpr double kLeastCommand = -0.4;
constexpr double kGreatestCommand = 1.0;
constexpr double kGust = 0.02;  // m/s^2, rad/s^2
constexpr double kGustLastsS = 4.0;
constexpr double kPositionNoiseM = 0.05;
constexpr double kHeadingNoiseDeg = 0.3;

GaussMarkov Gusts(std::uint64_t seed, std::uint64_t stream, double step_s) {
  return {kGust, kGustLastsS, step_s, WhiteSource(seed, stream)};
}

double Uniform(RandomEngine& random, double low, double high) {
  constexpr std::uint64_t kSteps = 1000;
  return low + (high - low) * static_cast<double>(DrawBelow(random, kSteps)) / kSteps;
}

}  // namespace

LoadBoat::LoadBoat(const Vehicle& vehicle, const FrameOrigin& origin, std::uint64_t seed,
                   double step_s)
    : vehicle_(vehicle),
      model_(VesselModelOf(PriorOf(vehicle).mean, vehicle.propeller_separation_m)),
      step_s_(step_s),
      frame_(origin),
      random_(seed),
      white_(seed, 1),
      gusts_{Gusts(seed, 2, step_s), Gusts(seed, 3, step_s), Gusts(seed, 4, step_s)} {}

void LoadBoat::Step() {
  held_for_s_ -= step_s_;
  if (held_for_s_ <= 0.0) DrawCommands();
  state_ = Advance(model_, state_, command_, step_s_);
  state_.nu.u += step_s_ * gusts_[0].Next();
  state_.nu.v += step_s_ * gusts_[1].Next();
  state_.nu.r += step_s_ * gusts_[2].Next();
}

void LoadBoat::DrawCommands() {
  held_for_s_ = Uniform(random_, kShortestHoldS, kLongestHoldS);
  command_.port = Uniform(random_, kLeastCommand, kGreatestCommand);
  command_.starboard = Uniform(random_, kLeastCommand, kGreatestCommand);
}

GnssFix LoadBoat::Fix(double time_s) {
  const double north_m = state_.eta.x_m + kPositionNoiseM * white_();
  const double east_m = state_.eta.y_m + kPositionNoiseM * white_();
  const GeographicPosition position = frame_.Inverse({north_m, east_m});
  return {time_s, position.latitude_deg, position.longitude_deg};
}

HeadingSample LoadBoat::Heading(double time_s) {
  const double psi_deg = state_.eta.psi_rad * kDegreesPerRadian;
  return {time_s, Wrap360(psi_deg + kHeadingNoiseDeg * white_())};
}

ThrusterSample LoadBoat::Commands(double time_s) const {
  return {time_s, vehicle_.port.PulseWidth(command_.port),
          vehicle_.starboard.PulseWidth(command_.starboard)};
}

}  // namespace telltale
