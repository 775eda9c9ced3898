#include "telltale/client/fleet/request_reply.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "support/made_up_identifications.hpp"
#include "support/special_values.hpp"
#include "telltale/client/fleet/identification_client.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// Answers every request for an identification with one and the same reply, once it has been busy
/// for some of them.
class FakeDaemon {
 public:
  FakeDaemon(const Participant& participant, IdentifyReply reply, int busy = 0)
      : reply_(std::move(reply)),
        busy_(busy),
        wait_set_(participant),
        progress_(participant),
        replies_(participant),
        requests_(participant) {
    wait_set_.Attach(requests_, [this] {
      requests_.Take([this](const auto& request) {
        ++requests_taken_;
        deadline_s_ = request.deadline_s;
        reply_.correlation_id = request.correlation_id;
        replies_.Write(Encode(busy_-- > 0 ? BusyReply() : reply_));
      });
    });
    thread_ = std::thread([this] {
      while (!stopping_) wait_set_.Wait(100ms);
    });
  }
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;
  ~FakeDaemon() {
    stopping_ = true;
    wait_set_.Wake();
    thread_.join();
  }

  int requests_taken() const { return requests_taken_; }
  double deadline_s() const { return deadline_s_; }  ///< of the last request

 private:
  IdentifyReply BusyReply() const {
    IdentifyReply busy;
    busy.correlation_id = reply_.correlation_id;
    busy.vehicle_id = reply_.vehicle_id;
    busy.outcome = ReplyOutcome::kFailed;
    busy.message = "busy";
    busy.retry_after_s = 0.05;
    return busy;
  }

  IdentifyReply reply_;
  int busy_;
  std::atomic<int> requests_taken_ = 0;
  std::atomic<double> deadline_s_ = 0.0;
  WaitSet wait_set_;
  Writer<telltale_wire_IdentifyProgress> progress_;
  Writer<telltale_wire_IdentifyReply> replies_;
  Reader<telltale_wire_IdentifyRequest> requests_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

IdentifyReply Published(const Identification& identification) {
  IdentifyReply reply;
  reply.vehicle_id = identification.vehicle_id;
  reply.outcome = ReplyOutcome::kPublished;
  reply.model = PublishedModel{identification, 3, 1.0};
  return reply;
}

class RequestReplyTest : public testing::Test {
 protected:
  IdentifyResult Ask(const IdentifyReply& reply) {
    const FakeDaemon daemon(there_, reply);
    IdentificationClient client(here_);
    IdentifyRequest request;
    request.correlation_id = "asked";
    request.vehicle_id = "made-up.1";
    return client.Identify(request, {.match = 20s, .reply = 60s, .retry = 100ms});
  }

  LoopbackDomain domain_;
  Participant here_{domain_.id()};
  Participant there_{domain_.id()};
  IdentifyReply reply_ = Published(MadeUpIdentification());
};

TEST_F(RequestReplyTest, ReturnsTheReply) {
  const auto result = Ask(reply_);
  ASSERT_EQ(result.outcome, RequestOutcome::kPublished);
  EXPECT_EQ(result.reply->model->revision, 3u);
}

// To wait on for another would be to wait in vain: an id is answered once.
TEST_F(RequestReplyTest, NamesTheFieldOfAnUnreadableReply) {
  reply_.model->identification.coefficients[3].standard_error = kNan;
  const auto result = Ask(reply_);
  ASSERT_EQ(result.outcome, RequestOutcome::kUnreadable);
  EXPECT_FALSE(result.reply);
  EXPECT_EQ(result.unreadable->field, "coefficients[3].standard_error");
}

TEST_F(RequestReplyTest, AsksABusyDaemonAgainAndSaysHowLongItWaits) {
  const FakeDaemon daemon(there_, reply_, 2);
  IdentificationClient client(here_);
  IdentifyRequest request;
  request.correlation_id = "asked";
  request.vehicle_id = "made-up.1";
  const auto result = client.Identify(request, {.match = 20s, .reply = 60s, .retry = 30s});
  ASSERT_EQ(result.outcome, RequestOutcome::kPublished);
  EXPECT_EQ(daemon.requests_taken(), 3);
  EXPECT_GT(daemon.deadline_s(), 0.0);
  EXPECT_LE(daemon.deadline_s(), 60.0);
}

TEST_F(RequestReplyTest, SaysThatTheDaemonStaysBusy) {
  const FakeDaemon daemon(there_, reply_, 1'000'000);
  IdentificationClient client(here_);
  IdentifyRequest request;
  request.correlation_id = "asked";
  request.vehicle_id = "made-up.1";
  const auto result = client.Identify(request, {.match = 20s, .reply = 500ms, .retry = 30s});
  ASSERT_EQ(result.outcome, RequestOutcome::kFailed);
  EXPECT_EQ(result.reply->message, "busy");
}

}  // namespace
}  // namespace telltale
