#pragma once

#include <string>

#include "telltale/idl/codec/messages/diagnosis.hpp"

namespace telltale {

/// report.json of a published diagnosis: with the revision it held against the window, and its
/// time.
std::string PrintReportJson(const PublishedDiagnosis& diagnosis);

}  // namespace telltale
