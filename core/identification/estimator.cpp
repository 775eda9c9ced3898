#include "telltale/core/identification/estimator.hpp"

namespace telltale {

std::string_view Name(Estimator estimator) {
  switch (estimator) {
    case Estimator::kOneStep: return "ONE_STEP";
    case Estimator::kWeakIv: return "WEAK_IV";
    case Estimator::kOutputError: return "OUTPUT_ERROR";
    case Estimator::kPredictionError: return "PREDICTION_ERROR";
    case Estimator::kUnknown: break;
  }
  return "UNKNOWN";
}

}  // namespace telltale
