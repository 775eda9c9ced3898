#include "telltale/idl/codec/messages/fleet_exchange.hpp"

namespace telltale {

std::string_view Name(FleetCommand command) {
  switch (command) {
    case FleetCommand::kUnknown: return "UNKNOWN";
    case FleetCommand::kList: return "LIST";
    case FleetCommand::kHistory: return "HISTORY";
    case FleetCommand::kModels: return "MODELS";
    case FleetCommand::kDiagnoses: return "DIAGNOSES";
    case FleetCommand::kRollback: return "ROLLBACK";
    case FleetCommand::kRefresh: return "REFRESH";
    case FleetCommand::kFollow: return "FOLLOW";
    case FleetCommand::kCancel: return "CANCEL";
  }
  return "";
}

std::string_view Name(RefreshState state) {
  switch (state) {
    case RefreshState::kUnknown: return "UNKNOWN";
    case RefreshState::kWaiting: return "WAITING";
    case RefreshState::kRunning: return "RUNNING";
    case RefreshState::kPublished: return "PUBLISHED";
    case RefreshState::kUnchanged: return "UNCHANGED";
    case RefreshState::kRefused: return "REFUSED";
    case RefreshState::kFailed: return "FAILED";
    case RefreshState::kCancelled: return "CANCELLED";
  }
  return "";
}

bool IsFinal(RefreshState state) {
  return state != RefreshState::kUnknown && state != RefreshState::kWaiting &&
         state != RefreshState::kRunning;
}

}  // namespace telltale
