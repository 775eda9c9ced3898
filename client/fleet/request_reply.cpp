#include "telltale/client/fleet/request_reply.hpp"

#include <array>
#include <cstdio>
#include <random>

namespace telltale {

RequestOutcome OutcomeOf(ReplyOutcome outcome) {
  switch (outcome) {
    case ReplyOutcome::kPublished: return RequestOutcome::kPublished;
    case ReplyOutcome::kRefused: return RequestOutcome::kRefused;
    case ReplyOutcome::kFailed: return RequestOutcome::kFailed;
    case ReplyOutcome::kAnswered: return RequestOutcome::kAnswered;
    case ReplyOutcome::kUnknown: break;
  }
  return RequestOutcome::kUnknown;
}

std::string NewCorrelationId() {
  std::random_device random;
  std::string id;
  for (int i = 0; i < 4; ++i) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(random()));
    id += digits.data();
  }
  return id;
}

}  // namespace telltale
