#pragma once

#include <functional>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/fleet/exchange.hpp"
#include "telltale/idl/codec/messages.hpp"

namespace telltale {

using DiagnoseAnswer = ExchangeAnswer<DiagnoseReply>;

/// Asks the daemon for diagnoses of its windows.
class DiagnosisClient {
 public:
  explicit DiagnosisClient(const Participant& participant) : exchange_(participant) {}

  /// Blocks until the answer is there. `progress` runs on the calling thread.
  /// Requires: identifiers of 1..64 letters, digits, '.', '_' or '-'.
  DiagnoseAnswer Diagnose(const DiagnoseRequest& request, const ExchangeTiming& timing,
                          const std::function<void(const DiagnoseProgress&)>& progress = {}) {
    return exchange_.Ask<DiagnoseReply, DiagnoseProgress>(request, timing, progress);
  }

 private:
  Exchange<telltale_wire_DiagnoseRequest, telltale_wire_DiagnoseProgress,
           telltale_wire_DiagnoseReply>
      exchange_;
};

}  // namespace telltale
