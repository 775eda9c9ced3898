#pragma once

#include "telltale/client/bus/qos.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// What a topic promises: its name and its quality of service.
struct Contract {
  const char* topic;
  Qos (*qos)();
};

/// The contract under which a wire type travels. Every type has exactly one topic.
template <class Wire>
inline constexpr Contract kContract{};

template <>
inline constexpr Contract kContract<telltale_wire_GnssFix>{"telltale/telemetry/gnss", TelemetryQos};
template <>
inline constexpr Contract kContract<telltale_wire_Heading>{"telltale/telemetry/heading",
                                                           TelemetryQos};
template <>
inline constexpr Contract kContract<telltale_wire_Thrusters>{"telltale/telemetry/thrusters",
                                                             TelemetryQos};
template <>
inline constexpr Contract kContract<telltale_wire_VehicleAnnouncement>{"telltale/vehicle",
                                                                       VehicleQos};
template <>
inline constexpr Contract kContract<telltale_wire_IdentifyRequest>{"telltale/identify/request",
                                                                   RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_IdentifyProgress>{"telltale/identify/progress",
                                                                    RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_IdentifyReply>{"telltale/identify/reply",
                                                                 RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_DiagnoseRequest>{"telltale/diagnose/request",
                                                                   RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_DiagnoseProgress>{"telltale/diagnose/progress",
                                                                    RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_DiagnoseReply>{"telltale/diagnose/reply",
                                                                 RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_FleetRequest>{"telltale/fleet/request",
                                                                RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_FleetProgress>{"telltale/fleet/progress",
                                                                 RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_FleetReply>{"telltale/fleet/reply",
                                                              RequestReplyQos};
template <>
inline constexpr Contract kContract<telltale_wire_Diagnosis>{"telltale/diagnosis", DiagnosisQos};
template <>
inline constexpr Contract kContract<telltale_wire_Model>{"telltale/model", ModelQos};
template <>
inline constexpr Contract kContract<telltale_wire_Quality>{"telltale/quality", QualityQos};
template <>
inline constexpr Contract kContract<telltale_wire_DaemonStatus>{"telltale/daemon", DaemonStatusQos};

}  // namespace telltale
