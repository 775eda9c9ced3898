#include "telltale/idl/codec/wire/daemon_status.hpp"

#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale {

telltale_wire_DaemonStatus Encode(const DaemonStatus& status) {
  telltale_wire_DaemonStatus wire{};
  wire::PutIdentifier(wire.daemon_id, status.daemon_id);
  wire.serves = status.serves;
  wire.term = status.term;
  wire.ownership_strength = status.ownership_strength;
  return wire;
}

Decoded<DaemonStatus> Decode(const telltale_wire_DaemonStatus& wire) {
  return wire::Guarded([&] {
    DaemonStatus status;
    status.daemon_id = wire::ReadIdentifier("daemon_id", wire.daemon_id);
    status.serves = wire.serves;
    const double first_term = wire.serves ? 1.0 : 0.0;
    wire::ReadWithin("term", wire.term, {first_term, double{kHighestTerm}});
    wire::ReadWithin("ownership_strength", wire.ownership_strength,
                     {1.0, double{kHighestStrength}});
    status.term = wire.term;
    status.ownership_strength = wire.ownership_strength;
    return status;
  });
}

}  // namespace telltale
