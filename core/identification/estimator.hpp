#pragma once

#include <string_view>

namespace telltale {

/// kOneStep: least squares of one-step differences, the paper's. kWeakIv: weak form with
/// instrumental variables. kOutputError: multiple shooting of all three equations together.
/// kPredictionError: the innovations of a Kalman filter, for the structure kFossen alone.
enum class Estimator { kUnknown, kOneStep, kWeakIv, kOutputError, kPredictionError };

std::string_view Name(Estimator estimator);

}  // namespace telltale
