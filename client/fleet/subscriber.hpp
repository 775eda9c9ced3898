#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/fleet/newest_models.hpp"
#include "telltale/idl/codec/wire/diagnosis.hpp"
#include "telltale/idl/codec/wire/model.hpp"
#include "telltale/idl/codec/wire/quality.hpp"

namespace telltale {

/// One topic of the fleet on a wait set that may follow others too. What cannot be decoded goes to
/// `reject` with the field at fault. Belongs to the wait set's thread.
template <class Wire, class Message>
class TopicSubscription {
 public:
  TopicSubscription(const Participant& participant, WaitSet& wait_set,
                    std::function<void(const Message&)> receive,
                    std::function<void(const CodecError&)> reject)
      : wait_set_(wait_set), reader_(participant) {
    wait_set_.Attach(reader_, [this, receive = std::move(receive), reject = std::move(reject)] {
      reader_.Take([&](const Wire& wire) {
        const auto message = Decode(wire);
        message ? receive(*message) : reject(message.error());
      });
    });
  }
  TopicSubscription(const TopicSubscription&) = delete;
  TopicSubscription& operator=(const TopicSubscription&) = delete;
  ~TopicSubscription() { wait_set_.Detach(reader_); }

  /// Whether anyone publishes on this topic.
  bool Connected() const { return reader_.Matched() > 0; }

 private:
  WaitSet& wait_set_;
  Reader<Wire> reader_;
};

/// Published models. One that is older than what was received of its vehicle, by revision and by
/// time, is passed over: a daemon that others could not hear for a while may still publish it.
class ModelSubscription : public TopicSubscription<telltale_wire_Model, PublishedModel> {
 public:
  ModelSubscription(const Participant& participant, WaitSet& wait_set,
                    std::function<void(const PublishedModel&)> receive,
                    std::function<void(const CodecError&)> reject)
      : TopicSubscription(
            participant, wait_set,
            [newest = NewestModels(),
             receive = std::move(receive)](const PublishedModel& model) mutable {
              if (newest.Admit(model)) receive(model);
            },
            std::move(reject)) {}
};

/// Follows one topic of the fleet.
template <class Subscription, class Message>
class Subscriber {
 public:
  Subscriber(const Participant& participant, std::function<void(const Message&)> receive,
             std::function<void(const CodecError&)> reject)
      : wait_set_(participant),
        subscription_(participant, wait_set_, std::move(receive), std::move(reject)) {}

  /// Waits for messages and hands them on, on this thread; false when none came within `timeout`.
  bool Wait(std::chrono::nanoseconds timeout) { return wait_set_.Wait(timeout); }

  /// Whether anyone publishes on this topic.
  bool Connected() const { return subscription_.Connected(); }

 private:
  WaitSet wait_set_;
  Subscription subscription_;
};

/// Published models and diagnoses; who joins late is given the last of each vehicle.
using DiagnosisSubscription = TopicSubscription<telltale_wire_Diagnosis, PublishedDiagnosis>;
using ModelSubscriber = Subscriber<ModelSubscription, PublishedModel>;
using DiagnosisSubscriber = Subscriber<DiagnosisSubscription, PublishedDiagnosis>;
using QualitySubscriber = Subscriber<TopicSubscription<telltale_wire_Quality, Quality>, Quality>;

}  // namespace telltale
