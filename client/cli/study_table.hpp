#pragma once

#include <string>

#include "telltale/core/paper/study.hpp"

namespace telltale {

/// A study in the paper's layout: our figures with the published ones beside them, and the columns
/// the paper lacks.
std::string StudyTable(const Study& study);

}  // namespace telltale
