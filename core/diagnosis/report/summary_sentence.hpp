#pragma once

#include <string>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// The diagnosis in one sentence: the cause, its probability where it is not certain, and the share
/// of the gap that it explains.
std::string SummarySentence(const Diagnosis& diagnosis);

}  // namespace telltale
