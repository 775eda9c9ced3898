#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/effects/effect.hpp"
#include "telltale/core/uncertainty/circular_interval.hpp"
#include "telltale/core/uncertainty/interval.hpp"
#include "telltale/core/validation/validation.hpp"
#include "telltale/core/vessel/model_structure.hpp"
#include "telltale/core/vessel/propellers.hpp"

namespace telltale {

enum class Verdict {
  kUnknown,  ///< not diagnosed
  kNoMaterialGap,
  kExplained,
  kPartlyExplained,
  kUnknownCause,
  kInsufficientData
};

/// The name in report.json: "NO_MATERIAL_GAP".
std::string_view Name(Verdict verdict);

/// Free-run error over windows of one length, times the normal error, docs/concepts/diagnosis.md
/// (80).
struct GapSize {
  double before = 0.0;
  double after = 0.0;        ///< with the likely effects in the model; as before without any
  double noise_floor = 0.0;  ///< of nominal recordings, geometric mean
  double floor_limit = 0.0;  ///< 95 % of nominal recordings stay below it
};

/// (before^2 - after^2) / (before^2 - floor^2), cross-validated.
struct ExcessExplained {
  double share = 0.0;
  Interval interval;
};

struct Gap {
  double horizon_s = 0.0;
  GapSize all;
  std::array<GapSize, 3> channels;                  ///< along, across, heading: surge, sway, yaw
  std::optional<ExcessExplained> excess_explained;  ///< none where there is no gap to close
  std::array<std::optional<ExcessExplained>, 3> channel_excess_explained;
  std::size_t windows = 0;
};

/// The kind of error that dominates in a cell, by Theil's decomposition: an offset, an error in
/// proportion to the prediction, the rest of the correlated error, or noise alone.
enum class GapKind { kUnknown, kBias, kSlope, kTiming, kNoise };

std::string_view Name(GapKind kind);

/// An operating condition with more error than the references have there.
struct GapCell {
  Equation channel = Equation::kUnknown;
  std::optional<PropellerRegion> region;  ///< none: all
  std::string bin;  ///< "0.5 to 1.0 m/s", "heading N", "first third", "after a step"; "" all
  double excess_share = 0.0;  ///< of all error above the floor
  double p_value = 1.0;       ///< family-wise over all cells (max-T)
  GapKind kind = GapKind::kUnknown;
  double mean = 0.0;  ///< error, times the normal error
  std::size_t windows = 0;
};

/// What a missing force is drawn over.
enum class ForceVariable {
  kUnknown,
  kSpeed,              ///< surge over ground, m/s
  kMeanCommand,        ///< of the two propellers, share of full
  kCommandDifference,  ///< port less starboard, likewise
  kHeading,            ///< degrees from north
  kTime                ///< seconds since the recording began
};

inline constexpr std::array kForceVariables = {ForceVariable::kSpeed, ForceVariable::kMeanCommand,
                                               ForceVariable::kCommandDifference,
                                               ForceVariable::kHeading, ForceVariable::kTime};

/// The name in report.json: "COMMAND_DIFFERENCE".
std::string_view Name(ForceVariable variable);

/// A mean with the half width of its 95 % interval, N or N m.
struct ForceMean {
  double mean = 0.0;
  double half_width = 0.0;
};

/// The missing force while a variable is between two values.
struct ForceBin {
  double low = 0.0;
  double high = 0.0;
  std::array<ForceMean, 3> force;  ///< surge and sway in N, yaw in N m
  std::size_t rows = 0;
};

struct ForceProfile {
  ForceVariable variable = ForceVariable::kUnknown;
  std::vector<ForceBin> bins;     ///< those with enough rows
  std::array<double, 3> share{};  ///< of the mean square that the variable holds; 0: chance alone
};

/// The force that the boat of the model lacks, MissingForceOf().
struct MissingForce {
  double mass_kg = 0.0;  ///< that turns accelerations into forces, without added mass
  std::array<ForceMean, 3> mean;
  std::array<double, 3> constant_share{};  ///< of the mean square that the mean holds
  std::array<double, 3> scatter{};         ///< root mean square of means over five seconds
  std::array<double, 3> excess{};          ///< that mean square over the references', less one
  std::vector<ForceProfile> over;          ///< in the order of kForceVariables
  std::string sentence;                    ///< which force it is, for people
};

struct ParameterEstimate {
  std::string name;
  double estimate = 0.0;
  double standard_error = 0.0;
  std::string unit;
};

struct CausalEffect {
  std::string effect;
  std::vector<ParameterEstimate> parameters;
  std::string sentence;        ///< "port thruster 22 % weaker"
  double shapley_share = 1.0;  ///< of what the effects of the cause explain together
  /// Of weather: the speed of wind or a current, the amplitude of the accelerations by waves.
  std::optional<ParameterEstimate> size = {};
  std::optional<CircularInterval> towards = {};  ///< of weather: where it runs to, 95 %
};

/// Effects that act together; without effects, the unknown cause, which the library lacks.
struct Cause {
  std::vector<CausalEffect> effects;
  double probability = 0.0;
  std::vector<std::string> indistinguishable;       ///< effects that explain this recording alike
  std::optional<ExcessExplained> excess_explained;  ///< at five seconds
};

enum class Testability { kUnknown, kTestable, kMasked, kNotExcited };

std::string_view Name(Testability testability);

/// The smallest size of one parameter of an effect that this recording shows with
/// kDiagnosis.testability.power, of either sign.
struct DetectableSize {
  std::string parameter;
  std::optional<double> size;  ///< positive; none where no size within the range shows so often
  std::string unit;
};

/// Whether this recording would show an effect at its typical size.
struct EffectTestability {
  std::string effect;
  Testability testability = Testability::kUnknown;
  double detectability = 0.0;  ///< sigmas that its typical size would show
  std::string masked_by;       ///< coefficient, "YAW uv", or weather; empty unless masked
  /// By parameter; none for a stochastic effect.
  std::vector<DetectableSize> detectable_sizes = {};
};

/// A manoeuvre that separates effects which this recording does not, or, where it names none, what
/// to record so that an unknown cause shows.
struct SeparationAdvice {
  std::string manoeuvre;
  std::string how;
  std::vector<std::string> separates;
  double duration_s = 0.0;
  double expected_nats = 0.0;
  bool decisive = false;  ///< more than five nats are expected
};

/// The answer without one of the references.
struct ReferenceInfluence {
  std::string reference;                ///< its name
  Verdict verdict = Verdict::kUnknown;  ///< unknown where the other references allow no diagnosis
  std::vector<std::string>
      effects;               ///< of the likeliest cause; empty where none is, or it is unknown
  double probability = 0.0;  ///< of that cause
  GapSize gap;               ///< at five seconds, of all channels
  /// That of this reference itself, which took no part; none where it has no window.
  std::optional<double> own_gap = {};
};

/// When the first cause began to act.
struct Onset {
  double time_s = 0.0;      ///< of the recording's clock
  double earliest_s = 0.0;  ///< of the 95 % interval
  double latest_s = 0.0;
};

/// One window of the main horizon, for the figures of a report.
struct WindowPicture {
  double time_s = 0.0;
  double before = 0.0;  ///< error of this window, times the normal error
  double after = 0.0;
  double psi_rad = 0.0;  ///< mean heading
  double speed_m_s = 0.0;
  PropellerRegion region = PropellerRegion::kFF;
  /// Mean errors along (m), across (m) and in heading (rad) at the window's end, before and after.
  Eigen::Vector3d error_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d error_after = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector2d> measured;  ///< north, east (m), at equal steps in time
  std::vector<Eigen::Vector2d> predicted_before;
  std::vector<Eigen::Vector2d> predicted_after;
};

/// Free-run scores on this recording of the old model and of the one identified again with the
/// likely effects. The latter was fitted to this recording.
struct Improvement {
  std::vector<FreeRunScores> before;
  std::vector<FreeRunScores> after;
};

/// A term of the log odds that the cause is one that the library lacks: its regressor and what it
/// adds, in nats. A positive one speaks for such a cause.
struct OddsTerm {
  std::string name;  ///< "log_misfit"
  double value = 0.0;
  double log_odds = 0.0;
};

/// A channel whose stamps may come late against the headings.
enum class DelayedChannel { kUnknown, kCommands, kFixes };

inline constexpr std::array kDelayedChannels = {DelayedChannel::kCommands, DelayedChannel::kFixes};

/// The name in report.json: "COMMANDS".
std::string_view Name(DelayedChannel channel);

/// By how much longer a channel of the recording is delayed than on nominal days, by the delays
/// that each recording alone shows; docs/concepts/diagnosis.md (120), (121).
struct DelayDifference {
  DelayedChannel channel = DelayedChannel::kUnknown;
  double difference_s = 0.0;
  double standard_deviation_s = 0.0;  ///< of one more nominal day
  /// -2 ln of the evidence for another delay, less that of a nominal day; negative where the delay
  /// is likelier another one.
  double score = 0.0;
  std::optional<double> detectable_s;  ///< that shows with kDiagnosis.testability.power
};

/// What the noise floor is measured on.
enum class FloorBasis { kUnknown, kReferenceLogs, kSensorNoise };

/// The result of Diagnose().
struct Diagnosis {
  std::string vehicle_id;
  Verdict verdict = Verdict::kUnknown;
  std::string sentence;  ///< the answer in one sentence, for people
  FloorBasis floor_basis = FloorBasis::kUnknown;
  std::size_t reference_logs = 0;
  double start_s = 0.0;
  double end_s = 0.0;
  std::vector<Gap> gaps;                   ///< horizons of 1, 5 and 10 s, ascending
  std::vector<GapCell> where;              ///< most excess first
  std::vector<Cause> causes;               ///< most probable first
  std::vector<OddsTerm> unknown_odds;      ///< of the unknown cause; none without causes
  std::vector<DelayDifference> delays;     ///< none of a free form, which estimates none
  std::vector<EffectTestability> effects;  ///< in the order of the library
  /// The weather beside which they would have to show; none where the recording shows none.
  std::vector<std::string> present_weather;
  std::vector<SeparationAdvice> advice;  ///< best first
  /// What each reference does to the answer, in their order; none where it was not asked for.
  std::vector<ReferenceInfluence> reference_influence;
  /// The gap at five seconds that 99 % of nominal days stay below, docs/concepts/diagnosis.md
  /// (123); none where fewer than two references were left out.
  std::optional<double> nominal_days_limit;
  std::optional<Onset> onset;
  std::string rest;  ///< where the unexplained error sits: "yaw, FR"; empty where none does
  std::optional<Improvement> improvement;
  std::optional<MissingForce> missing_force;  ///< where a gap has no certain cause
  std::vector<WindowPicture> pictures;
  std::vector<std::string> notes;  ///< limitations, as sentences
  std::uint64_t seed = 0;
  std::string software_version;

  /// The gap at five seconds, which the verdict is about.
  const Gap& Main() const;
};

}  // namespace telltale
