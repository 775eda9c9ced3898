#pragma once

#include <array>

#include "telltale/idl/codec/messages/exchange.hpp"

/// The enumerators that a field of that type may have, without the unknown one. Private to
/// idl/codec/wire.
namespace telltale::wire {

inline constexpr std::array kStructures = {Structure::kStaticQuadratic,
                                           Structure::kFirstOrderDynamic, Structure::kFossen};
inline constexpr std::array kParameterizations = {Parameterization::kPropeller,
                                                  Parameterization::kPaper};
/// Of a request; the physical form has an estimator of its own, which its structure asks for.
inline constexpr std::array kEstimators = {Estimator::kOneStep, Estimator::kWeakIv,
                                           Estimator::kOutputError};
inline constexpr std::array kModelEstimators = {
    Estimator::kOneStep, Estimator::kWeakIv, Estimator::kOutputError, Estimator::kPredictionError};
inline constexpr std::array kPresets = {Preset::kRobust, Preset::kPaper};
inline constexpr std::array kResamplings = {Resampling::kSlices, Resampling::kMovingBlocks,
                                            Resampling::kParametric};
inline constexpr std::array kIntervalMethods = {IntervalMethod::kPercentile,
                                                IntervalMethod::kStudentized, IntervalMethod::kBca};
inline constexpr std::array kRecordingBiasModels = {RecordingBiasModel::kShared,
                                                    RecordingBiasModel::kPerRecording,
                                                    RecordingBiasModel::kPerRecordingNorthEast};
inline constexpr std::array kDeadZoneSources = {DeadZoneSource::kGiven,
                                                DeadZoneSource::kIdentified};
inline constexpr std::array kCoefficientStatuses = {
    CoefficientStatus::kEstimated, CoefficientStatus::kNotExcited, CoefficientStatus::kCollinear,
    CoefficientStatus::kPrior};
inline constexpr std::array kChangeVerdicts = {
    ChangeVerdict::kNoSignificantChange, ChangeVerdict::kChanged, ChangeVerdict::kInconclusive};
inline constexpr std::array kPromotionVerdicts = {PromotionVerdict::kOk, PromotionVerdict::kWarn,
                                                  PromotionVerdict::kError};
inline constexpr std::array kReplyOutcomes = {ReplyOutcome::kPublished, ReplyOutcome::kRefused,
                                              ReplyOutcome::kFailed, ReplyOutcome::kAnswered};

}  // namespace telltale::wire
