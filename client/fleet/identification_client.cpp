#include "fleet/identification_client.hpp"

#include <array>
#include <cstdio>
#include <random>

#include "codec/wire.hpp"

namespace telltale {
namespace {

using Clock = std::chrono::steady_clock;

ExchangeOutcome OutcomeOf(const IdentifyReply& reply) {
  switch (reply.outcome) {
    case IdentifyOutcome::kPublished: return ExchangeOutcome::kPublished;
    case IdentifyOutcome::kRefused: return ExchangeOutcome::kRefused;
    case IdentifyOutcome::kFailed: return ExchangeOutcome::kFailed;
    case IdentifyOutcome::kUnknown: break;
  }
  return ExchangeOutcome::kUnknown;
}

}  // namespace

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

IdentificationClient::IdentificationClient(const Participant& participant)
    : participant_(participant),
      requests_(participant),
      progress_(participant),
      replies_(participant) {}

IdentifyAnswer IdentificationClient::Identify(
    const IdentifyRequest& request, const ExchangeTiming& timing,
    const std::function<void(const IdentifyProgress&)>& progress) {
  const auto wire = Encode(request);
  if (!WaitForMatch(participant_, {requests_, replies_, progress_}, timing.match)) {
    return {ExchangeOutcome::kNoDaemon, std::nullopt};
  }

  IdentifyAnswer answer;
  const auto now = Clock::now();
  const auto deadline = now + timing.reply;
  auto next_request = now;
  WaitSet news(participant_);
  news.Attach(progress_, [&] {
    progress_.Take([&](const telltale_wire_IdentifyProgress& sample) {
      const auto decoded = Decode(sample);
      if (!decoded || decoded->correlation_id != request.correlation_id) return;
      next_request = Clock::now() + timing.retry;
      if (progress) progress(*decoded);
    });
  });
  news.Attach(replies_, [&] {
    replies_.Take([&](const telltale_wire_IdentifyReply& sample) {
      auto decoded = Decode(sample);
      if (!decoded || decoded->correlation_id != request.correlation_id) return;
      answer = {OutcomeOf(*decoded), std::move(*decoded)};
    });
  });

  while (!answer.reply) {
    if (Clock::now() >= deadline) return {ExchangeOutcome::kTimedOut, std::nullopt};
    if (Clock::now() >= next_request) {
      requests_.Write(wire);
      next_request = Clock::now() + timing.retry;
    }
    news.Wait(std::min(next_request, deadline) - Clock::now());
  }
  return answer;
}

}  // namespace telltale
