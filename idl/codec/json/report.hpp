#pragma once

#include <string>
#include <string_view>

#include "telltale/core/diagnosis/diagnosis.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/json/window_pictures.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// Diagnosis -> the message of report.json. The worst windows alone keep their paths; counts beyond
/// 32 bits saturate. Requires a gap at one horizon or more.
proto::Report ToProto(const Diagnosis& diagnosis);

/// The way back. Errors name the fields as report.json does; `file` is their name for the text.
/// Refuses: an id that is none; an unset or unknown verdict, basis or testability; no horizons;
/// times that are NaN; and what ReadGap(), ReadGapCell(), ReadCause() and ReadPicture() refuse.
Decoded<Diagnosis> DiagnosisOf(const proto::Report& report, const std::string& file = "report");

/// report.json.
std::string PrintReportJson(const Diagnosis& diagnosis);

/// The way back. Refuses also text that is not JSON, and unknown fields.
Decoded<Diagnosis> ParseReportJson(std::string_view text, const std::string& file = "report");

}  // namespace telltale
