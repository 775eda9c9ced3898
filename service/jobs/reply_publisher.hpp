#pragma once

#include <string>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/messages/fleet_exchange.hpp"
#include "telltale/service/role.hpp"

namespace telltale {

/// Sends progress and replies to the clients that ask for something. Safe to
/// use from several threads. A call blocks for at most the 100 ms of the topics' contract and never
/// throws: it logs what it cannot send, and a client that misses an answer asks again. It sends
/// nothing while the daemon does not serve: another answers then.
class ReplyPublisher {
 public:
  ReplyPublisher(const Participant& participant, const Role& role);

  void Send(const IdentifyProgress& progress);
  void Send(const IdentifyReply& reply);
  void Send(const DiagnoseProgress& progress);
  void Send(const DiagnoseReply& reply);
  void Send(const FleetProgress& progress);
  void Send(const FleetReply& reply);

 private:
  template <class Wire>
  void Send(Writer<Wire>& writer, const WireSample<Wire>& wire, const std::string& correlation_id);

  const Role& role_;
  Writer<telltale_wire_IdentifyProgress> progress_writer_;
  Writer<telltale_wire_IdentifyReply> reply_writer_;
  Writer<telltale_wire_DiagnoseProgress> diagnose_progress_writer_;
  Writer<telltale_wire_DiagnoseReply> diagnose_reply_writer_;
  Writer<telltale_wire_FleetProgress> fleet_progress_writer_;
  Writer<telltale_wire_FleetReply> fleet_reply_writer_;
};

}  // namespace telltale
