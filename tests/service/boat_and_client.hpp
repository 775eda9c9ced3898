#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "telltale/client/bus/participant.hpp"
#include "telltale/client/bus/reader.hpp"
#include "telltale/client/bus/wait_set.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/client/fleet/telemetry_publisher.hpp"
#include "telltale/core/data/recording_parts.hpp"
#include "telltale/idl/codec/wire/exchange.hpp"

namespace telltale {

using CampaignClock = std::chrono::steady_clock;

inline constexpr double kSentAtOnceS = 0.5;  ///< of telemetry at a time
/// So the boat lives at ten times real time.
inline constexpr std::chrono::milliseconds kSentEvery{50};

inline double SecondsSince(CampaignClock::time_point since) {
  return std::chrono::duration<double>(CampaignClock::now() - since).count();
}

/// A boat that speaks, and a client that notes what it is told.
class BoatAndClient {
 public:
  BoatAndClient(std::uint32_t domain, Recording recording)
      : participant_(domain),
        wait_set_(participant_),
        qualities_(
            participant_, wait_set_,
            [this](const Quality& quality) {
              if (quality.vehicle_id != "yellowfish") return;
              if (!newest_quality_) reported_at_ = CampaignClock::now();
              newest_quality_ = quality;
            },
            [](const CodecError& error) { ADD_FAILURE() << error.Message(); }),
        models_(
            participant_, wait_set_, [this](const PublishedModel& model) { Note(model); },
            [](const CodecError& error) { ADD_FAILURE() << error.Message(); }),
        publisher_(participant_, "yellowfish"),
        recording_(std::move(recording)) {
    wait_set_.Attach(progress_, [this] {
      progress_.Take([this](const auto& wire) { acknowledged_.insert(wire.correlation_id); });
    });
    wait_set_.Attach(replies_, [this] {
      replies_.Take([this](const auto& wire) {
        if (const auto reply = Decode(wire)) Note(*reply);
      });
    });
  }

  /// False where the daemon that was just started is not connected within a minute. Ends that a
  /// killed daemon left count as connected for some time: only a report shows that this one is.
  bool AwaitDaemon() {
    newest_quality_.reset();
    return Await([this] { return newest_quality_.has_value(); }) &&
           WaitForMatch(participant_, {requests_, progress_, replies_}, std::chrono::seconds(60)) &&
           publisher_.WaitForReaders(std::chrono::seconds(60));
  }

  /// When the next report comes, while the boat speaks on; nothing where none comes within a
  /// minute.
  std::optional<CampaignClock::time_point> SpeakUntilReport() {
    newest_quality_.reset();
    const auto deadline = CampaignClock::now() + std::chrono::seconds(60);
    while (!newest_quality_ && CampaignClock::now() < deadline) Step();
    return newest_quality_ ? std::optional(reported_at_) : std::nullopt;
  }

  template <class Condition>
  bool Await(Condition condition) {
    const auto deadline = CampaignClock::now() + std::chrono::seconds(60);
    while (!condition() && CampaignClock::now() < deadline)
      wait_set_.Wait(std::chrono::milliseconds(100));
    return condition();
  }

  /// Sends the next telemetry, and handles what comes until the step is over.
  void Step() {
    const auto end = CampaignClock::now() + kSentEvery;
    const Recording part = Between(recording_, sent_to_s_, sent_to_s_ + kSentAtOnceS);
    for (const GnssFix& fix : part.gnss) publisher_.Publish(fix);
    for (const HeadingSample& sample : part.heading) publisher_.Publish(sample);
    for (const ThrusterSample& sample : part.thrusters) publisher_.Publish(sample);
    sent_to_s_ += kSentAtOnceS;
    sent_at_.emplace(sent_to_s_, CampaignClock::now());
    Handle(end - CampaignClock::now());
  }

  void Handle(std::chrono::nanoseconds duration) {
    const auto end = CampaignClock::now() + duration;
    do {
      wait_set_.Wait(end - CampaignClock::now());
    } while (CampaignClock::now() < end);
  }

  void Send(const IdentifyRequest& request) { requests_.Write(Encode(request)); }

  /// The reply, asked for until it comes; nothing where that takes longer.
  std::optional<IdentifyReply> Ask(const IdentifyRequest& request,
                                   std::chrono::seconds patience = std::chrono::seconds(60)) {
    const auto deadline = CampaignClock::now() + patience;
    while (!ReplyTo(request.correlation_id) && CampaignClock::now() < deadline) {
      Send(request);
      const auto again = CampaignClock::now() + std::chrono::seconds(1);
      while (!ReplyTo(request.correlation_id) && CampaignClock::now() < again) {
        wait_set_.Wait(again - CampaignClock::now());
      }
    }
    return ReplyTo(request.correlation_id);
  }

  std::optional<IdentifyReply> ReplyTo(const std::string& correlation_id) const {
    const auto found = replies_seen_.find(correlation_id);
    return found == replies_seen_.end() ? std::nullopt : std::optional(found->second);
  }
  bool Acknowledged(const std::string& correlation_id) const {
    return acknowledged_.contains(correlation_id);
  }

  /// Those of the requests that were acknowledged and have no reply.
  std::set<std::string> Unanswered(const std::set<std::string>& asked) const {
    std::set<std::string> unanswered;
    for (const std::string& id : asked) {
      if (Acknowledged(id) && !ReplyTo(id)) unanswered.insert(id);
    }
    return unanswered;
  }

  /// The requests that have been answered with two models.
  const std::set<std::string>& answered_differently() const { return answered_differently_; }

  /// When each revision was published, by what the topic has said so far.
  const std::map<std::uint64_t, double>& published() const { return published_; }

  /// The time of the fix that the newest report names. Empty where there is none such.
  std::optional<double> ReportedFixS() const {
    if (!newest_quality_ || !newest_quality_->position) return std::nullopt;
    const QualityPosition& position = *newest_quality_->position;
    const auto fix = std::ranges::find_if(recording_.gnss, [&](const GnssFix& one) {
      return one.latitude_deg == position.latitude_deg &&
             one.longitude_deg == position.longitude_deg;
    });
    return fix == recording_.gnss.end() ? std::nullopt : std::optional(fix->time_s);
  }

  /// The span of the window that the newest report names.
  double ReportedWindowS() const { return newest_quality_ ? newest_quality_->window_s : 0.0; }

  /// What was sent until now is not counted by SentBefore(): a daemon that was killed has lost it,
  /// and its kill counts it.
  void ForgetWhatWasSent() { counted_from_s_ = sent_to_s_; }

  /// How long before `until` the first fix after `time_s` was sent; 0 where there is none.
  double SentBefore(double time_s, CampaignClock::time_point until) const {
    const auto next = std::ranges::upper_bound(recording_.gnss, std::max(time_s, counted_from_s_),
                                               {}, &GnssFix::time_s);
    if (next == recording_.gnss.end() || next->time_s > sent_to_s_) return 0.0;
    const auto sent = sent_at_.lower_bound(next->time_s);
    return std::chrono::duration<double>(until - sent->second).count();
  }
  double sent_to_s() const { return sent_to_s_; }

 private:
  void Note(const PublishedModel& model) {
    const std::uint64_t newest = published_.empty() ? 0 : published_.rbegin()->first;
    EXPECT_GE(model.revision, newest);
    const auto [known, is_new] = published_.emplace(model.revision, model.published_unix_s);
    // The same revision again is the same model.
    EXPECT_EQ(known->second, model.published_unix_s) << "revision " << model.revision;
  }

  void Note(const IdentifyReply& reply) {
    const auto [known, is_new] = replies_seen_.emplace(reply.correlation_id, reply);
    const bool is_another = !is_new && known->second.model && reply.model &&
                            known->second.model->revision != reply.model->revision;
    if (is_another) answered_differently_.insert(reply.correlation_id);
    known->second = reply;
  }

  Participant participant_;
  WaitSet wait_set_;
  Writer<telltale_wire_IdentifyRequest> requests_{participant_};
  Reader<telltale_wire_IdentifyProgress> progress_{participant_};
  Reader<telltale_wire_IdentifyReply> replies_{participant_};
  TopicSubscription<telltale_wire_Quality, Quality> qualities_;
  TopicSubscription<telltale_wire_Model, PublishedModel> models_;  ///< all that is published
  TelemetryPublisher publisher_;
  Recording recording_;
  double sent_to_s_ = -1e-9;
  double counted_from_s_ = -1e-9;
  std::map<double, CampaignClock::time_point> sent_at_;  ///< by the end of the step
  std::optional<Quality> newest_quality_;
  CampaignClock::time_point reported_at_;  ///< the first since there was none
  std::set<std::string> acknowledged_;
  std::map<std::string, IdentifyReply> replies_seen_;
  std::set<std::string> answered_differently_;
  std::map<std::uint64_t, double> published_;
};

}  // namespace telltale
