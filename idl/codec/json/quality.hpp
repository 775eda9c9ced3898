#pragma once

#include <string>

#include "telltale/idl/codec/messages/quality.hpp"
#include "telltale/idl/proto/quality.pb.h"

namespace telltale {

/// Quality -> the message of its JSON. Counts beyond 32 bits saturate.
proto::Quality ToProto(const Quality& quality, double time_unix_s);

proto::Quality::Position ToProto(const QualityPosition& position);

/// The quality as one line of JSON, without a line feed.
std::string PrintQualityLine(const Quality& quality, double time_unix_s);

}  // namespace telltale
