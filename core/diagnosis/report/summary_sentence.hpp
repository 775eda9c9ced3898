#pragma once

#include <string>

#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// The answer in one sentence: what, how sure, how much of the gap.
std::string SummarySentence(const Diagnosis& diagnosis);

}  // namespace telltale
