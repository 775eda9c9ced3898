#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/base/result.hpp"
#include "telltale/core/effects/effect.hpp"
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

/// "NO_MATERIAL_GAP" and so on.
std::string_view Name(Verdict verdict);

/// Free-run error over windows of one length, in nominal sigmas, docs/concepts/diagnosis.md (80).
struct GapSize {
  double before = 0.0;
  double after = 0.0;        ///< with the likely effects in the model; as before without any
  double noise_floor = 0.0;  ///< of nominal boats
  double floor_limit = 0.0;  ///< which 95 % of nominal recordings stay below
};

/// (before^2 - after^2) / (before^2 - floor^2) on windows that did not take part in fitting.
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

/// What kind of error dominates where model and boat part: an offset, in proportion to what the
/// model does, the rest, or more noise alone (Theil).
enum class GapKind { kUnknown, kBias, kSlope, kTiming, kNoise };

std::string_view Name(GapKind kind);

/// A corner of the data that holds more error than it should.
struct GapCell {
  Equation channel = Equation::kUnknown;
  std::optional<PropellerRegion> region;  ///< none: all
  std::string bin;  ///< "0.5 to 1.0 m/s", "heading N", "first third", "after a step"; "" all
  double excess_share = 0.0;  ///< of all error above the floor
  double p_value = 1.0;       ///< corrected for looking at every cell (max-T)
  GapKind kind = GapKind::kUnknown;
  double mean = 0.0;  ///< error in nominal sigmas
  std::size_t windows = 0;
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
  double shapley_share = 1.0;  ///< of what its combination closes
};

/// One answer to "which": effects that act together; no effects: something the library lacks.
struct Cause {
  std::vector<CausalEffect> effects;
  double probability = 0.0;
  std::vector<std::string> indistinguishable;       ///< effects this recording cannot tell it from
  std::optional<ExcessExplained> excess_explained;  ///< at five seconds
};

enum class Testability { kUnknown, kTestable, kMasked, kNotExcited };

std::string_view Name(Testability testability);

/// Whether this recording would show an effect.
struct EffectTestability {
  std::string effect;
  Testability testability = Testability::kUnknown;
  double detectability = 0.0;  ///< sigmas that its typical size would show
  std::string masked_by;       ///< coefficient: "YAW uv"
};

/// A manoeuvre that would separate what is tied.
struct SeparationAdvice {
  std::string manoeuvre;
  std::string how;
  std::vector<std::string> separates;
  double duration_s = 0.0;
  double expected_nats = 0.0;
  bool decisive = false;  ///< it is expected to settle the matter: above five nats
};

/// When the first cause began, where that shows.
struct Onset {
  double time_s = 0.0;      ///< of the recording's clock
  double earliest_s = 0.0;  ///< 95 %
  double latest_s = 0.0;
};

/// What the pictures are drawn from.
struct WindowPicture {
  double time_s = 0.0;
  double before = 0.0;  ///< error of this window in nominal sigmas
  double after = 0.0;
  double psi_rad = 0.0;  ///< mean heading
  double speed_m_s = 0.0;
  PropellerRegion region = PropellerRegion::kFF;
  /// Mean errors along (m), across (m) and in heading (rad) at the window's end, before and after.
  Eigen::Vector3d error_before = Eigen::Vector3d::Zero();
  Eigen::Vector3d error_after = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector2d> measured;  ///< north, east (m), at equal steps through the window
  std::vector<Eigen::Vector2d> predicted_before;
  std::vector<Eigen::Vector2d> predicted_after;
};

/// The old model and the one identified again with the likely effects, by their free runs on this
/// recording's windows that did not take part in fitting.
struct Improvement {
  std::vector<FreeRunScores> before;
  std::vector<FreeRunScores> after;
};

/// What a floor rests on.
enum class FloorBasis { kUnknown, kReferenceLogs, kSensorNoise };

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
  std::vector<EffectTestability> effects;  ///< in the order of the library
  std::vector<SeparationAdvice> advice;    ///< best first
  std::optional<Onset> onset;
  std::string rest;  ///< where what stays unexplained sits: "yaw, FR"; empty where none does
  std::optional<Improvement> improvement;
  std::vector<WindowPicture> pictures;
  std::vector<std::string> notes;  ///< what limits the answer
  std::uint64_t seed = 0;
  std::string software_version;

  /// The gap at five seconds, which the verdict is about.
  const Gap& Main() const;
};

}  // namespace telltale
