#pragma once

#include <chrono>
#include <functional>

#include <gtest/gtest.h>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/messages/exchange.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"

namespace telltale {

/// Writes a request again and again until `is_known`, for a minute at most, as clients do: what is
/// written before both ends know of each other is lost. `wait_set` hears what makes it known.
template <class Wire>
void WriteUntil(Writer<telltale_wire_IdentifyRequest>& requests, const Wire& request,
                WaitSet& wait_set, const std::function<bool()>& is_known) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::minutes(1);
  while (!is_known() && Clock::now() < deadline) {
    requests.Write(request);
    const auto again = Clock::now() + std::chrono::milliseconds(200);
    while (!is_known() && Clock::now() < again) wait_set.Wait(again - Clock::now());
  }
}

/// Asks until the daemon reports of the request.
inline void AskUntilReported(const Participant& participant,
                             Writer<telltale_wire_IdentifyRequest>& requests,
                             const IdentifyRequest& request) {
  Reader<telltale_wire_IdentifyProgress> progress(participant);
  bool is_reported = false;
  WaitSet wait_set(participant);
  wait_set.Attach(progress, [&] {
    progress.Take([&](const telltale_wire_IdentifyProgress& sample) {
      const auto report = Decode(sample);
      is_reported = is_reported || (report && report->correlation_id == request.correlation_id);
    });
  });
  WriteUntil(requests, Encode(request), wait_set, [&] { return is_reported; });
  EXPECT_TRUE(is_reported) << request.correlation_id;
}

}  // namespace telltale
