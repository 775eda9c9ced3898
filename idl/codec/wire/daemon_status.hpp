#pragma once

#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/messages/daemon_status.hpp"
#include "telltale/idl/codec/wire/wire_sample.hpp"

namespace telltale {

/// DaemonStatus <-> wire.
telltale_wire_DaemonStatus Encode(const DaemonStatus& status);

/// Refuses a daemon id that is not IsVehicleId(), a term or a strength out of range, and a daemon
/// that serves without a term.
Decoded<DaemonStatus> Decode(const telltale_wire_DaemonStatus& wire);

}  // namespace telltale
