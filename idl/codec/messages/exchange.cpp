#include "telltale/idl/codec/messages/exchange.hpp"

namespace telltale {

std::string_view Name(ReplyOutcome outcome) {
  switch (outcome) {
    case ReplyOutcome::kUnknown: return "UNKNOWN";
    case ReplyOutcome::kPublished: return "PUBLISHED";
    case ReplyOutcome::kRefused: return "REFUSED";
    case ReplyOutcome::kFailed: return "FAILED";
    case ReplyOutcome::kAnswered: return "ANSWERED";
  }
  return "";
}

}  // namespace telltale
