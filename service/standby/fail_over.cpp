#include "telltale/service/standby/fail_over.hpp"

#include <cstring>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

#include "telltale/client/fleet/request_reply.hpp"
#include "telltale/idl/codec/wire/daemon_status.hpp"
#include "telltale/service/jobs/job.hpp"

namespace telltale {
namespace {

DaemonStatus NewDaemon(const StandbySettings& settings, std::uint32_t latest_term) {
  DaemonStatus self;
  self.daemon_id = NewCorrelationId();
  self.ownership_strength = settings.ownership_strength;
  self.term = latest_term;
  return self;
}

}  // namespace

std::chrono::nanoseconds LeaseOf(const StandbySettings& settings) {
  return std::chrono::ceil<std::chrono::nanoseconds>(
      std::chrono::duration<double>(settings.lease_s));
}

FailOver::FailOver(const Participant& participant, const StandbySettings& settings, TermStore terms,
                   Role& role, HeardRequests& requests, const Mirror::Into& mirrored,
                   Handlers handlers)
    : patience_(LeaseOf(settings) / 8),
      role_(role),
      requests_(requests),
      handlers_(std::move(handlers)),
      status_writer_(participant, WithLease(DaemonStatusQos(), LeaseOf(settings))),
      wait_set_(participant),
      statuses_(participant, FromOthers(DaemonStatusQos())),
      identify_replies_(participant, FromOthers(RequestReplyQos())),
      diagnose_replies_(participant, FromOthers(RequestReplyQos())),
      fleet_replies_(participant, FromOthers(RequestReplyQos())),
      identify_progress_(participant, FromOthers(RequestReplyQos())),
      diagnose_progress_(participant, FromOthers(RequestReplyQos())),
      refresh_progress_(participant, FromOthers(RequestReplyQos())),
      mirror_(participant, wait_set_, role, mirrored),
      election_(NewDaemon(settings, terms.Latest()), LeaseOf(settings), Clock::now()),
      terms_(std::move(terms)) {}

FailOver::~FailOver() {
  stopping_ = true;
  wait_set_.Wake();
  if (thread_.joinable()) thread_.join();
}

void FailOver::Start() {
  Follow();
  thread_ = std::thread([this] { Run(); });
}

/// Hears of the other daemons, of the answers that they give and of what they work on.
void FailOver::Follow() {
  wait_set_.Attach(statuses_, [this] {
    statuses_.Take(
        [this](const telltale_wire_DaemonStatus& wire) {
          const auto status = Decode(wire);
          const std::lock_guard lock(mutex_);
          if (status) election_.Hear(*status, Clock::now());
        },
        [this](const telltale_wire_DaemonStatus& gone) {
          const std::lock_guard lock(mutex_);
          election_.Lose({gone.daemon_id, strnlen(gone.daemon_id, sizeof gone.daemon_id)});
        });
  });
  FollowAnswers();
  FollowProgress();
}

void FailOver::FollowAnswers() {
  const auto forget_answered = [this](auto& replies) {
    wait_set_.Attach(replies, [this, &replies] {
      replies.Take([this](const auto& wire) {
        const bool is_final = wire.retry_after_s <= 0.0;
        if (is_final && wire.correlation_id != nullptr) requests_.Answered(wire.correlation_id);
      });
    });
  };
  forget_answered(identify_replies_);
  forget_answered(diagnose_replies_);
  forget_answered(fleet_replies_);
}

/// A refresh that has any progress has begun.
void FailOver::FollowProgress() {
  const auto note_begun = [this](auto& reports) {
    wait_set_.Attach(reports, [this, &reports] {
      reports.Take([this](const auto& wire) {
        if (wire.correlation_id == nullptr || wire.stage == nullptr) return;
        if (wire.stage != kQueuedStage) requests_.Begun(wire.correlation_id);
      });
    });
  };
  note_begun(identify_progress_);
  note_begun(diagnose_progress_);
  wait_set_.Attach(refresh_progress_, [this] {
    refresh_progress_.Take([this](const telltale_wire_FleetProgress& wire) {
      if (wire.correlation_id != nullptr) requests_.Begun(wire.correlation_id);
    });
  });
}

void FailOver::Heartbeat(bool has_heard_fleet) {
  if (stepped_down_) return;
  if (has_heard_fleet) {
    const std::lock_guard lock(mutex_);
    election_.HearFleet(Clock::now());
  }
  role_.Renew(Clock::now());
  Publish(Self());
}

DaemonStatus FailOver::Self() const {
  const std::lock_guard lock(mutex_);
  return election_.self();
}

bool FailOver::HasFollowed() const {
  const std::lock_guard lock(mutex_);
  return election_.HasFollowed();
}

void FailOver::Publish(const DaemonStatus& status) {
  if (!status_writer_.Write(Encode(status))) spdlog::warn("the status of this daemon is blocked");
}

void FailOver::Run() {
  while (!stopping_) {
    try {
      wait_set_.Wait(patience_);
      if (!stepped_down_) Decide();
    } catch (const std::exception& error) {
      spdlog::error("standby: {}", error.what());
    }
  }
}

void FailOver::Decide() {
  const auto step = [this] {
    const std::lock_guard lock(mutex_);
    return election_.Decide(Clock::now());
  }();
  if (step == Election::Step::kTakeOver) return TakeOver();
  if (step == Election::Step::kStepDown) return StepDown("another daemon serves for a later term");
  const DaemonStatus self = Self();
  if (self.serves && !role_.Serves()) return StepDown("its working loop came late");
  if (self.serves || !HasFollowed()) return;
  NoteTerm(self.term);
  mirror_.FillHoles(Clock::now());
}

void FailOver::NoteTerm(std::uint32_t term) {
  if (std::exchange(followed_term_, term) == term) return;
  spdlog::info("another daemon serves, for term {}; this one stands by", term);
  Keep(term);
}

/// A daemon whose disk refuses goes on: where both then start again at once, the one with the
/// earlier models may serve.
void FailOver::Keep(std::uint32_t term) {
  try {
    terms_.Keep(term);
  } catch (const DatabaseError& error) {
    spdlog::error("{}; term {} is not kept", error.what(), term);
  }
}

void FailOver::TakeOver() {
  const bool succeeds = HasFollowed();
  {
    const std::lock_guard lock(mutex_);
    election_.TakeOver();
  }
  const DaemonStatus self = Self();
  spdlog::warn("this daemon serves from now on, for term {}", self.term);
  Keep(self.term);
  role_.Assume(Clock::now());
  try {
    Publish(self);
    handlers_.take_over(OwnershipStrengthOn(self), succeeds);
  } catch (const std::exception& error) {
    StepDown(error.what());
  }
}

void FailOver::StepDown(const std::string& why) {
  spdlog::error("this daemon does not serve any more: {}", why);
  stepped_down_ = true;
  role_.Resign();
  handlers_.step_down();
}

}  // namespace telltale
