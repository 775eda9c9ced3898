#pragma once

#include <string>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// A diagnosis for people: the sentence first, then the gap by horizon and channel, where it sits,
/// causes, what the effects improve, what this recording could show and the recommended
/// manoeuvres.
std::string DiagnosisTable(const Diagnosis& diagnosis);

}  // namespace telltale
