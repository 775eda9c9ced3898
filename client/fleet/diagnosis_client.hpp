#pragma once

#include <functional>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

using DiagnoseResult = ReplyResult<DiagnoseReply>;

/// Asks the daemon for diagnoses of its windows.
class DiagnosisClient {
 public:
  explicit DiagnosisClient(const Participant& participant) : request_reply_(participant) {}

  /// Blocks until the answer is there. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  DiagnoseResult Diagnose(const DiagnoseRequest& request, const RequestTiming& timing,
                          const std::function<void(const DiagnoseProgress&)>& progress = {}) {
    return request_reply_.Ask<DiagnoseReply, DiagnoseProgress>(request, timing, progress);
  }

 private:
  RequestReply<telltale_wire_DiagnoseRequest, telltale_wire_DiagnoseProgress,
               telltale_wire_DiagnoseReply>
      request_reply_;
};

}  // namespace telltale
