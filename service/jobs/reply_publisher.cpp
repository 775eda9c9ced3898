#include "telltale/service/jobs/reply_publisher.hpp"

#include <spdlog/spdlog.h>

#include "telltale/idl/codec/wire/exchange.hpp"
#include "telltale/idl/codec/wire/fleet_exchange.hpp"

namespace telltale {

ReplyPublisher::ReplyPublisher(const Participant& participant, const Role& role)
    : role_(role),
      progress_writer_(participant),
      reply_writer_(participant),
      diagnose_progress_writer_(participant),
      diagnose_reply_writer_(participant),
      fleet_progress_writer_(participant),
      fleet_reply_writer_(participant) {}

void ReplyPublisher::Send(const IdentifyProgress& progress) {
  Send(progress_writer_, Encode(progress), progress.correlation_id);
}

void ReplyPublisher::Send(const IdentifyReply& reply) {
  Send(reply_writer_, Encode(reply), reply.correlation_id);
}

void ReplyPublisher::Send(const DiagnoseProgress& progress) {
  Send(diagnose_progress_writer_, Encode(progress), progress.correlation_id);
}

void ReplyPublisher::Send(const DiagnoseReply& reply) {
  Send(diagnose_reply_writer_, Encode(reply), reply.correlation_id);
}

void ReplyPublisher::Send(const FleetProgress& progress) {
  Send(fleet_progress_writer_, Encode(progress), progress.correlation_id);
}

void ReplyPublisher::Send(const FleetReply& reply) {
  Send(fleet_reply_writer_, Encode(reply), reply.correlation_id);
}

template <class Wire>
void ReplyPublisher::Send(Writer<Wire>& writer, const WireSample<Wire>& wire,
                          const std::string& correlation_id) {
  if (!role_.Serves()) return;
  try {
    if (!writer.Write(wire)) spdlog::warn("{}: a stalled client blocks the answer", correlation_id);
  } catch (const BusError& error) {
    spdlog::error("{}: {}", correlation_id, error.what());
  }
}

}  // namespace telltale
