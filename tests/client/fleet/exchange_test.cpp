#include "telltale/client/fleet/exchange.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "support/identifications.hpp"
#include "support/loopback_domain.hpp"
#include "support/numbers.hpp"
#include "telltale/client/fleet/identification_client.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// Answers every request for an identification with one and the same reply.
class Answering {
 public:
  Answering(const Participant& participant, IdentifyReply reply)
      : reply_(std::move(reply)),
        news_(participant),
        progress_(participant),
        replies_(participant),
        requests_(participant) {
    news_.Attach(requests_, [this] {
      requests_.Take([this](const auto& request) {
        reply_.correlation_id = request.correlation_id;
        replies_.Write(Encode(reply_));
      });
    });
    thread_ = std::thread([this] {
      while (!stopping_) news_.Wait(100ms);
    });
  }
  Answering(const Answering&) = delete;
  Answering& operator=(const Answering&) = delete;
  ~Answering() {
    stopping_ = true;
    news_.Wake();
    thread_.join();
  }

 private:
  IdentifyReply reply_;
  WaitSet news_;
  Writer<telltale_wire_IdentifyProgress> progress_;
  Writer<telltale_wire_IdentifyReply> replies_;
  Reader<telltale_wire_IdentifyRequest> requests_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

IdentifyReply Published(const Identification& identification) {
  IdentifyReply reply;
  reply.vehicle_id = identification.vehicle_id;
  reply.outcome = IdentifyOutcome::kPublished;
  reply.model = PublishedModel{identification, 3, 1.0};
  return reply;
}

class ExchangeTest : public testing::Test {
 protected:
  IdentifyAnswer Ask(const IdentifyReply& reply) {
    const Answering daemon(there_, reply);
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

TEST_F(ExchangeTest, BringsTheAnswer) {
  const auto answer = Ask(reply_);
  ASSERT_EQ(answer.outcome, ExchangeOutcome::kPublished);
  EXPECT_EQ(answer.reply->model->revision, 3u);
}

// To wait on for another would be to wait in vain: an id is answered once.
TEST_F(ExchangeTest, SaysWhatInAnAnswerCannotBeRead) {
  reply_.model->identification.coefficients[3].standard_error = kNan;
  const auto answer = Ask(reply_);
  ASSERT_EQ(answer.outcome, ExchangeOutcome::kUnreadable);
  EXPECT_FALSE(answer.reply);
  EXPECT_EQ(answer.unreadable->field, "coefficients[3].standard_error");
}

}  // namespace
}  // namespace telltale
