#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/propellers.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/field_reader.hpp"

namespace telltale {

/// The ranges of a model's fields, the same in model.json and on the bus.
inline constexpr FieldRange kSamplingPeriodS{0.001, 10.0};
inline constexpr FieldRange kDeadZoneForward{0.0, kWidestDeadZone};
inline constexpr FieldRange kDeadZoneReverse{-kWidestDeadZone, 0.0};
inline constexpr FieldRange kIntervalLevel{0.0, 1.0, true};
inline constexpr FieldRange kDisturbanceTimeConstantS{0.001, kLargest};
inline constexpr FieldRange kConditionNumber{1.0, kNotNan.high};
inline constexpr FieldRange kDegreesOfFreedom{1.0, kLargest};
inline constexpr FieldRange kCombinationWeight{-1.0, 1.0};

/// The first fault of what the fields of a model must satisfy together, or nothing:
/// - an equation has either no coefficients or those of Regressors(), in their order, with their
///   symbols and units; the equations come in the order surge, sway, yaw;
/// - the covariance has variances that are not negative, finite covariances, and is symmetric.
/// Assumes a covariance that is square over the coefficients.
std::optional<CodecError> ModelFault(const Identification& identification);

/// The first fault of the parameters of the physical form, or nothing: they are those of
/// FossenParameterNames(), in their order. `field` is where they stand.
std::optional<CodecError> ParametersFault(const std::string& field,
                                          const std::vector<Coefficient>& parameters);

}  // namespace telltale
