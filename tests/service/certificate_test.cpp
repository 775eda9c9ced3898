#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "telltale/client/fleet/identification_client.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

class Certificates : public ServiceTest {
 protected:
  /// One-step with bounds from residuals: a repeat takes milliseconds.
  IdentifyRequest Certified(const std::string& correlation_id, std::uint32_t repeats) const {
    IdentifyRequest request = Request(correlation_id);
    request.estimator = Estimator::kOneStep;
    request.bootstrap_replicates = 0;
    request.certificate_twins = repeats;
    return request;
  }

  /// A daemon learns of a client's ends in the order they were made, progress before replies: once
  /// it was heard refusing, no progress is lost for want of a listener.
  void MeetDaemon(IdentificationClient& client) const {
    IdentifyRequest refused = Request("met");
    refused.vehicle_id = "nobody";
    ASSERT_EQ(client.Identify(refused, kTiming).outcome, ExchangeOutcome::kFailed);
  }

  static constexpr ExchangeTiming kTiming{.match = 60s, .reply = 60s, .retry = 1s};
};

TEST_F(Certificates, TravelWithThePublishedModel) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  MeetDaemon(client);
  std::vector<std::string> stages;
  const auto answer =
      client.Identify(Certified("certified", 10), kTiming,
                      [&](const IdentifyProgress& progress) { stages.push_back(progress.stage); });
  ASSERT_EQ(answer.outcome, ExchangeOutcome::kPublished) << daemon->output();
  const Identification& identification = answer.reply->model->identification;
  ASSERT_TRUE(identification.certificate.has_value());
  EXPECT_EQ(identification.certificate->asked, 10u);
  EXPECT_GT(identification.certificate->answered, 0u);
  EXPECT_EQ(identification.certificate->coefficients.size(), identification.coefficients.size());
  EXPECT_FALSE(identification.excitation.empty());
  EXPECT_THAT(stages, testing::Contains(testing::HasSubstr("certifying")));
}

TEST_F(Certificates, ANumberOutOfRangeFailsAndNamesTheRange) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const auto answer = client.Identify(Certified("too-few", 3), kTiming);
  ASSERT_EQ(answer.outcome, ExchangeOutcome::kFailed);
  EXPECT_THAT(answer.reply->message, testing::HasSubstr("[10, 1000]"));
}

}  // namespace
}  // namespace telltale
