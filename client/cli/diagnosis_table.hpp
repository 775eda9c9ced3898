#pragma once

#include <string>

#include "telltale/core/diagnosis/report/diagnosis.hpp"

namespace telltale {

/// A diagnosis for people: the sentence first, then the gap by horizon and channel, where it sits,
/// causes, what this recording could show at all, what to sail next and what the effects improve.
std::string DiagnosisTable(const Diagnosis& diagnosis);

}  // namespace telltale
