#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/core/diagnosis/report/diagnosis.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/proto/report.pb.h"

namespace telltale {

/// How many windows a report shows the paths of.
inline constexpr std::size_t kShownPaths = 6;

/// The windows with paths that the model misses most, at most kShownPaths, in order of time.
std::vector<std::size_t> WorstWindows(const std::vector<WindowPicture>& pictures);

/// Diagnosis -> the message that rests in report.json. Paths are kept of the worst windows alone;
/// counts beyond 32 bits saturate. Requires: a gap at one horizon or more.
proto::Report ToProto(const Diagnosis& diagnosis);

/// The way back. Refuses: an unset or unknown verdict, channel, region, kind or testability;
/// probabilities and shares outside [0, 1]; numbers that are NaN; parameters of an effect that the
/// cause does not name; paths that do not come in pairs or of different lengths; no horizons.
Decoded<Diagnosis> DiagnosisOf(const proto::Report& report, const std::string& file = "report");

/// report.json.
std::string PrintReportJson(const Diagnosis& diagnosis);
Decoded<Diagnosis> ParseReportJson(std::string_view text, const std::string& file = "report");

}  // namespace telltale
