#include "telltale/client/fleet/exchange.hpp"

#include <array>
#include <cstdio>
#include <random>

namespace telltale {

ExchangeOutcome OutcomeOf(IdentifyOutcome outcome) {
  switch (outcome) {
    case IdentifyOutcome::kPublished: return ExchangeOutcome::kPublished;
    case IdentifyOutcome::kRefused: return ExchangeOutcome::kRefused;
    case IdentifyOutcome::kFailed: return ExchangeOutcome::kFailed;
    case IdentifyOutcome::kUnknown: break;
  }
  return ExchangeOutcome::kUnknown;
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
