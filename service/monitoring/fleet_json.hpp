#pragma once

#include <span>

#include "telltale/idl/proto/fleet.pb.h"
#include "telltale/service/monitoring/fleet_view.hpp"

namespace telltale {

/// What is known of the fleet -> the messages of /api/v1 and /events. Counts beyond 32 bits
/// saturate.
proto::VehicleSummary SummaryOf(const Quality& quality);
proto::Job ToProto(const JobView& job);
proto::DiagnosisList ToProto(std::span<const PublishedDiagnosis> diagnoses);
proto::History ToProto(std::span<const PastPoint> past);

}  // namespace telltale
