#pragma once

#include <string>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// A diagnosis as one HTML page that needs nothing else: styles and pictures are inside, there is
/// no script, and it reads on a phone as on a desk, in light and in dark. Requires: a gap at one
/// horizon or more.
std::string ReportPage(const Diagnosis& diagnosis);

}  // namespace telltale
