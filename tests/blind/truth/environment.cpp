#include "environment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace blind::truth {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLongestDayS = 4000.0;

/// Frequency over that of the peak and phase, as they stand in a wave train met at `place`.
double Phase(double frequency, double towards, const Place& place, double time_s) {
  const double wave_number = frequency * frequency / kGravity;  // deep water
  return frequency * time_s -
         wave_number * (place.north_m * std::cos(towards) + place.east_m * std::sin(towards));
}

/// Force and moment of a wave running towards a direction on the boat.
BodyForce OnBody(double force_n, double towards, double heading, double phase) {
  const double bearing = towards - heading;
  return {.x_n = force_n * std::cos(bearing) * std::sin(phase),
          .y_n = 1.2 * force_n * std::sin(bearing) * std::sin(phase),
          .n_nm = 0.25 * force_n * std::sin(2.0 * bearing) * std::cos(phase)};
}

void Add(BodyForce& sum, const BodyForce& force) {
  sum.x_n += force.x_n;
  sum.y_n += force.y_n;
  sum.n_nm += force.n_nm;
}

/// Distance run along a direction.
double Along(const Place& place, double towards) {
  return place.north_m * std::cos(towards) + place.east_m * std::sin(towards);
}

/// The frequency, over that of the peak, below which a sea of Pierson and Moskowitz' spectrum has
/// this share of its energy: exp(-5/4 (peak / frequency)^4), the integral of f^-5 exp(-5/4 f^-4).
double PiersonMoskowitzQuantile(double share) {
  return std::pow(-1.25 / std::log(share), 0.25);
}

double GaussMarkovStep(double value, double time_constant_s, double dt_s, RandomStream& rng) {
  const double kept = std::exp(-dt_s / time_constant_s);
  return kept * value + std::sqrt(1.0 - kept * kept) * rng.Normal();
}

}  // namespace

Weather LightDay(RandomStream rng) {
  return {.wind_mps = rng.Uniform(0.3, 1.2),
          .wind_towards = rng.Angle(),
          .gust_share = 0.2,
          .gust_time_s = rng.Uniform(5.0, 12.0),
          .current_mps = rng.Uniform(0.0, 0.03),
          .current_towards = rng.Angle(),
          .current_drift_mps = 0.005,
          .wave_force_n = rng.Uniform(0.1, 0.5),
          .wave_period_s = rng.Uniform(1.5, 2.5),
          .wave_towards = rng.Angle()};
}

Environment::Environment(RandomStream rng) : rng_(rng.For("gusts")) {
  for (Component& component : swell_) {
    component = {.detuning = 1.0 + rng.Normal(0.07), .phase = rng.Angle(), .turn = rng.Normal()};
  }
  // Components of one energy each, one from every part of the spectrum.
  RandomStream sea = rng.For("wind sea");
  for (std::size_t at = 0; at < wind_sea_.size(); ++at) {
    const double below =
        (static_cast<double>(at) + sea.Uniform(0.0, 1.0)) / static_cast<double>(wind_sea_.size());
    wind_sea_[at] = {
        .detuning = PiersonMoskowitzQuantile(below), .phase = sea.Angle(), .turn = sea.Normal()};
  }
  for (double start = rng.Uniform(30.0, 90.0); start < kLongestDayS;
       start += rng.Uniform(80.0, 150.0)) {
    wash_starts_s_.push_back(start);
  }
  for (double end = rng.Uniform(2.0, 8.0); end < kLongestDayS; end += rng.Uniform(3.0, 9.0)) {
    spells_.push_back({.end_s = end, .threshold = rng.Uniform(0.0, 1.0)});
  }
  wash_towards_ = rng.Angle();
  shear_towards_ = rng.Angle();
  shear_across_ = shear_towards_ + 0.5 * std::numbers::pi;
  shoal_across_ = rng.Angle();
  front_m_ = rng.Uniform(-15.0, 15.0);
  gust_ = rng_.Normal();
  current_north_ = rng_.Normal();
  current_east_ = rng_.Normal();
}

void Environment::Advance(const Weather& weather, double dt_s) {
  gust_ = GaussMarkovStep(gust_, weather.gust_time_s, dt_s, rng_);
  current_north_ = GaussMarkovStep(current_north_, weather.current_drift_s, dt_s, rng_);
  current_east_ = GaussMarkovStep(current_east_, weather.current_drift_s, dt_s, rng_);
}

Surroundings Environment::At(const Scenario& scenario, const Place& place, double time_s) const {
  constexpr double kEddyLengthM = 70.0;
  constexpr double kFrontWidthM = 40.0;
  constexpr double kShoalLengthM = 60.0;
  const Weather& day = scenario.weather;
  const Faults& faults = scenario.faults;
  const double wind = std::max(0.0, day.wind_mps * (1.0 + day.gust_share * gust_));
  const double eddy = faults.eddy_mps *
                      std::sin(2.0 * std::numbers::pi * Along(place, shear_across_) / kEddyLengthM);
  const double from_front = Along(place, shear_across_) - front_m_;
  const double shear = eddy + faults.shear_mps * std::tanh(from_front / kFrontWidthM);
  const double shallows =
      std::sin(2.0 * std::numbers::pi * Along(place, shoal_across_) / kShoalLengthM);
  Surroundings here{
      .wind_north_mps = wind * std::cos(day.wind_towards),
      .wind_east_mps = wind * std::sin(day.wind_towards),
      .current_north_mps = day.current_mps * std::cos(day.current_towards) +
                           day.current_drift_mps * current_north_ +
                           shear * std::cos(shear_towards_),
      .current_east_mps = day.current_mps * std::sin(day.current_towards) +
                          day.current_drift_mps * current_east_ + shear * std::sin(shear_towards_),
      .waves = Waves(day, place, time_s),
      .shoal = faults.shoal_drag * 0.5 * (1.0 + std::tanh(4.0 * shallows)),
  };
  Add(here.waves, Wash(faults.wash_force_n, place, time_s));
  return here;
}

bool Environment::Weedy(double weed_share, double time_s) const {
  const auto now =
      std::lower_bound(spells_.begin(), spells_.end(), time_s,
                       [](const Spell& spell, double time) { return spell.end_s < time; });
  return now != spells_.end() && now->threshold < weed_share;
}

BodyForce Environment::Waves(const Weather& weather, const Place& place, double time_s) const {
  BodyForce sum;
  if (weather.wave_force_n == 0.0) return sum;
  const std::span<const Component> components =
      weather.is_wind_sea ? std::span<const Component>(wind_sea_) : swell_;
  const double force = weather.wave_force_n / std::sqrt(double(components.size()));
  for (const Component& component : components) {
    const double frequency = component.detuning * 2.0 * std::numbers::pi / weather.wave_period_s;
    const double towards = weather.wave_towards + weather.wave_spread_rad * component.turn;
    const double phase = Phase(frequency, towards, place, time_s) + component.phase;
    Add(sum, OnBody(force, towards, place.heading_rad, phase));
  }
  return sum;
}

BodyForce Environment::Wash(double force_n, const Place& place, double time_s) const {
  constexpr double kTrainS = 35.0;
  BodyForce sum;
  if (force_n == 0.0) return sum;
  for (const double start : wash_starts_s_) {
    const double since = time_s - start;
    if (since < 0.0 || since > kTrainS) continue;
    // The long waves of a wash run ahead of the short ones.
    const double frequency = 2.0 + 1.6 * since / kTrainS;
    const double swell = std::sin(std::numbers::pi * since / kTrainS);
    const double phase = Phase(frequency, wash_towards_, place, since);
    Add(sum, OnBody(force_n * swell * swell, wash_towards_, place.heading_rad, phase));
  }
  return sum;
}

}  // namespace blind::truth
