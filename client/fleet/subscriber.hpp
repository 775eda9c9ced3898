#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/wait_set.hpp"
#include "codec/wire.hpp"

namespace telltale {

/// Follows one topic of the fleet. What cannot be decoded goes to `reject` with the field at fault.
template <class Wire, class Message>
class Subscriber {
 public:
  Subscriber(const Participant& participant, std::function<void(const Message&)> receive,
             std::function<void(const CodecError&)> reject)
      : reader_(participant), news_(participant) {
    news_.Attach(reader_, [this, receive = std::move(receive), reject = std::move(reject)] {
      reader_.Take([&](const Wire& wire) {
        const auto message = Decode(wire);
        message ? receive(*message) : reject(message.error());
      });
    });
  }

  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  /// Waits for news and hands it on, on this thread; false when there was none within `timeout`.
  bool Wait(std::chrono::nanoseconds timeout) { return news_.Wait(timeout); }

  /// Whether anyone publishes on this topic.
  bool Connected() const { return reader_.Matched() > 0; }

 private:
  Reader<Wire> reader_;
  WaitSet news_;
};

/// Published models and diagnoses; who joins late is given the last of each vehicle.
using ModelSubscriber = Subscriber<telltale_wire_Model, PublishedModel>;
using DiagnosisSubscriber = Subscriber<telltale_wire_Diagnosis, PublishedDiagnosis>;
using QualitySubscriber = Subscriber<telltale_wire_Quality, Quality>;

}  // namespace telltale
