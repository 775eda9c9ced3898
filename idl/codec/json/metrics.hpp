#pragma once

#include <string>
#include <string_view>

#include "telltale/core/validation/validation.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/proto/metrics.pb.h"

namespace telltale {

proto::Metrics ToProto(const Metrics& metrics);
Metrics MetricsOf(const proto::Metrics& message);

/// The scores of one horizon.
proto::Metrics::FreeRun ToProto(const FreeRunScores& scores);
FreeRunScores ScoresOf(const proto::Metrics::FreeRun& message);

/// metrics.json. A score the data cannot give is NaN, which stands there as "NaN".
std::string PrintMetricsJson(const Metrics& metrics);

/// Refuses: text that is not metrics.json, with unknown fields or values of the wrong type.
Decoded<Metrics> ParseMetricsJson(std::string_view text, const std::string& file = "metrics");

}  // namespace telltale
