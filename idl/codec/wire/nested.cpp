#include "telltale/idl/codec/wire/nested.hpp"

#include "telltale/idl/codec/model_rules.hpp"
#include "telltale/idl/codec/wire/put.hpp"
#include "telltale/idl/codec/wire/read.hpp"

namespace telltale::wire {

void FillRefusal(telltale_wire_Refusal& wire, const Refusal& refusal) {
  Put(wire.subject, refusal.subject);
  Put(wire.reason, refusal.reason);
  Put(wire.advice, refusal.advice);
}

Refusal ReadRefusal(const std::string&, const telltale_wire_Refusal& wire) {
  return {TextOf(wire.subject), TextOf(wire.reason), TextOf(wire.advice)};
}

void FillRejectCount(telltale_wire_RejectCount& wire, const RejectEntry& entry) {
  Put(wire.channel, entry.channel);
  Put(wire.reason, entry.reason);
  wire.count = entry.count;
}

RejectEntry ReadRejectEntry(const std::string&, const telltale_wire_RejectCount& wire) {
  return {TextOf(wire.channel), TextOf(wire.reason), wire.count};
}

DeadZone ReadDeadZone(double forward, double reverse) {
  return {ReadWithin("dead_zone_forward", forward, kDeadZoneForward),
          ReadWithin("dead_zone_reverse", reverse, kDeadZoneReverse)};
}

}  // namespace telltale::wire
