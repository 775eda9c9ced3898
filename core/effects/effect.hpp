#pragma once

#include <array>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/effects/hull_scale.hpp"
#include "telltale/core/vessel/motion.hpp"
#include "telltale/core/vessel/regressors.hpp"
#include "telltale/core/vessel/side.hpp"
#include "telltale/core/vessel/vehicle.hpp"

namespace telltale {

/// One unknown of an effect. Assumes: zero means that the effect is not there, unless it only says
/// how the others act (a ratio), which `is_shape` marks.
struct EffectParameter {
  std::string_view name;
  std::string_view unit;
  double typical = 0.0;  ///< size met in practice, > 0; of a shaping parameter, its spread
  double lower = 0.0;    ///< range in which it is sought
  double upper = 0.0;
  bool is_shape = false;
  double prior_mean = 0.0;  ///< where it is expected: zero but for a shaping parameter
};

/// A number for each body term of surge, sway and yaw, in the order of Regressors().
struct HullTerms {
  std::array<double, 5> surge{};
  std::array<double, 9> sway{};
  std::array<double, 9> yaw{};
};

/// What a boat goes through at one instant of a free run, as the model has it.
struct InstantState {
  double time_s = 0.0;  ///< since the recording began
  double span_s = 0.0;  ///< how long the recording is
  double psi_rad = 0.0;
  double load = 0.0;            ///< mean squared command of the two propellers
  Nu nu;                        ///< over ground
  Nu nu_r;                      ///< through the water
  std::array<NuDot, 2> thrust;  ///< what each side's propeller gives, port first
  HullScale hull_scale;         ///< of the vehicle file's hull
  HullTerms hull;               ///< accelerations

  NuDot Thrust() const {
    return {thrust[0].u + thrust[1].u, thrust[0].v + thrust[1].v, thrust[0].r + thrust[1].r};
  }
  /// Of thrust and hull.
  NuDot Acceleration() const {
    const auto sum = [](const auto& terms) {
      return std::accumulate(terms.begin(), terms.end(), 0.0);
    };
    const NuDot driven = Thrust();
    return {driven.u + sum(hull.surge), driven.v + sum(hull.sway), driven.r + sum(hull.yaw)};
  }
};

/// Body accelerations in a narrow band that no free run can foretell, of random phase.
struct NarrowBandExcitation {
  Eigen::Vector3d amplitude = Eigen::Vector3d::Zero();  ///< m/s^2, m/s^2, rad/s^2
  double frequency_rad_s = 0.0;
};

using EffectValues = std::span<const double>;

/// Which of its hooks an effect overrides among those that are called at every step or sample.
enum class Hook { kNone, kCommand, kThrustShare, kAcceleration, kHeading };

/// Where a nominal boat's share of an effect is estimated: as a fixed effect, in the model's
/// coefficients, as a random effect of each recording, as weather is, or nowhere, since a nominal
/// boat has none.
enum class NominalVariation { kFixedEffect, kInCoefficients, kRecordingEffect, kNone };

/// What an effect is, for people and reports.
struct EffectFacts {
  std::string_view name;   ///< as in report.json: "hull_fouling"
  std::string_view title;  ///< in a sentence: "a fouled hull"
  std::string_view equation;
  std::string_view source;
  std::vector<EffectParameter> parameters;
  std::string_view settled_by;  ///< a sensor that would tell: "an anemometer"
  Hook hook = Hook::kNone;
  NominalVariation nominal_variation = NominalVariation::kFixedEffect;
  /// Scatter of those parameters that do not shape, from one free run to the next, as a share of
  /// their length: what blows in gusts or runs with the tide.
  double turbulence_intensity = 0.0;
  /// How long a gust lasts: the time constant of its correlation, of first order. 0 where a gust
  /// stays as it is throughout a free run. Of Hook::kThrustShare and kAcceleration alone.
  double turbulence_time_s = 0.0;
  /// How long what scatters stays from one free run to the next: the time constant of its
  /// correlation, of first order, the same for all effects that have one. 0 where each free run has
  /// its own.
  double drift_time_s = 0.0;
  /// Of what acts at times only, how far its size may scatter, in its unit, whatever the mean: the
  /// likeliest of these. That scatter is the effect; without it, it is another one. Such an effect
  /// has one parameter and acts on either side of zero.
  std::vector<double> intermittent_sds = {};
  /// Whether one of its parameters that do not shape is one where it acts: an output is stuck or
  /// not.
  bool is_all_or_nothing = false;
  /// Whether it is there on most days, beside whatever else acts.
  bool is_weather = false;
  /// What the length of its first two parameters is: "speed". Empty where it is nothing.
  std::string_view length_name = {};
  /// Whether these are components north and east.
  bool is_north_east = false;
};

/// Something that moves a boat, or what its sensors say, and that the model leaves out. An effect
/// overrides the hooks where it acts; the others leave the boat as it is. Every hook gets one value
/// per parameter. Effects act together in the order of the chain: commands, thrust, hull and
/// surroundings, sensors.
class Effect {
 public:
  explicit Effect(EffectFacts facts) : facts_(std::move(facts)) {}
  virtual ~Effect() = default;
  Effect(const Effect&) = delete;
  Effect& operator=(const Effect&) = delete;

  std::string_view Name() const { return facts_.name; }
  const EffectFacts& Facts() const { return facts_; }
  std::span<const EffectParameter> Parameters() const { return facts_.parameters; }

  /// Whether it excites the boat with random phase, which free runs cannot follow.
  bool IsStochastic() const {
    return StochasticExcitation(std::vector<double>(facts_.parameters.size(), 1.0)).has_value();
  }

  /// Whether it acts at times only.
  bool IsIntermittent() const { return !facts_.intermittent_sds.empty(); }

  /// What an operator would call it with these values: "port thruster 22 % weaker".
  virtual std::string Describe(EffectValues values) const = 0;

  /// Commands reach the thrusters so much later.
  virtual double CommandDelayS(EffectValues) const { return 0.0; }
  /// What a thruster makes of a command in [-1, 1]. Hook::kCommand.
  virtual double Command(EffectValues, Side, double delta) const { return delta; }
  /// Time that an output takes from neutral to full.
  virtual double OutputTravelS(EffectValues) const { return 0.0; }
  /// The shafts' speed, thrust being its square, follows the command by a first order of this time
  /// constant.
  virtual double ShaftLagS(EffectValues) const { return 0.0; }
  /// Share of its thrust that a propeller gives. Hook::kThrustShare.
  virtual double ThrustShare(EffectValues, Side, const InstantState&) const { return 1.0; }
  /// The water's velocity north and east.
  virtual Eigen::Vector2d Current(EffectValues) const { return Eigen::Vector2d::Zero(); }
  /// How that velocity changes with place, zero in the middle of the recording's track: a row for
  /// each of its components, a column for each metre north and east.
  virtual Eigen::Matrix2d CurrentGradient(EffectValues) const { return Eigen::Matrix2d::Zero(); }
  /// What else accelerates the boat. Hook::kAcceleration.
  virtual NuDot AddedAcceleration(EffectValues, const InstantState&) const { return {}; }
  /// The stochastic excitation of the boat.
  virtual std::optional<NarrowBandExcitation> StochasticExcitation(EffectValues) const {
    return std::nullopt;
  }
  /// Measured heading less true heading, at a true heading. Hook::kHeading.
  virtual double HeadingErrorRad(EffectValues, double /*psi_rad*/) const { return 0.0; }
  /// Where the antenna is, from where the vehicle file has it.
  virtual LeverArm AntennaShift(EffectValues) const { return {}; }
  /// Age of a position when it is stamped.
  virtual double LatencyS(EffectValues) const { return 0.0; }

 private:
  EffectFacts facts_;
};

/// Every effect, in the order of core/effects/effect_library.cpp. They live as long as the program.
std::span<const Effect* const> EffectLibrary();

/// Nothing where there is no such effect.
const Effect* FindEffect(std::string_view name);

/// An effect with numbers in it. Requires: one value per parameter.
struct ModelledEffect {
  const Effect* effect = nullptr;
  std::vector<double> values;

  bool operator==(const ModelledEffect&) const = default;
};

}  // namespace telltale
