#pragma once

#include <cstdint>

#include "telltale/idl/codec/messages/model.hpp"
#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/models/predicted_paths.hpp"

namespace telltale {

/// Whether the later model differs from the earlier one, with the answer as a sentence. Models that
/// cannot be compared have the verdict CANNOT_TELL and its reason.
proto::Comparison Compared(const PublishedModel& earlier, const PublishedModel& later);

proto::PredictedPaths ToProto(const PredictedPaths& paths, std::uint64_t revision);

}  // namespace telltale
