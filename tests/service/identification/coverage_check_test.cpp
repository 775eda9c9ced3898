#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/service_fixture.hpp"
#include "telltale/client/fleet/identification_client.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

class LiveCoverageCheck : public ServiceTest {
 protected:
  /// One-step with bounds from residuals: a repeat takes milliseconds.
  IdentifyRequest WithCoverageCheck(const std::string& correlation_id,
                                    std::uint32_t repeats) const {
    IdentifyRequest request = Request(correlation_id);
    request.estimator = Estimator::kOneStep;
    request.bootstrap_replicates = 0;
    request.coverage_check_replicates = repeats;
    return request;
  }

  static constexpr RequestTiming kTiming{.match = 60s, .reply = 120s, .retry = 1s};
};

TEST_F(LiveCoverageCheck, TravelWithThePublishedModel) {
  const auto daemon = StartDaemon();
  ReplaySimulation();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const auto answer = client.Identify(WithCoverageCheck("coverage-checked", 10), kTiming);
  ASSERT_EQ(answer.outcome, RequestOutcome::kPublished) << daemon->output();
  const Identification& identification = answer.reply->model->identification;
  ASSERT_TRUE(identification.coverage_check.has_value());
  EXPECT_EQ(identification.coverage_check->replicates_requested, 10u);
  EXPECT_GT(identification.coverage_check->replicates_identified, 0u);
  EXPECT_EQ(identification.coverage_check->coefficients.size(), identification.coefficients.size());
  EXPECT_FALSE(identification.excitation.empty());
}

TEST_F(LiveCoverageCheck, ANumberOutOfRangeFailsAndNamesTheRange) {
  const auto daemon = StartDaemon();
  const Participant participant(domain_.id());
  IdentificationClient client(participant);
  const auto answer = client.Identify(WithCoverageCheck("too-few", 3), kTiming);
  ASSERT_EQ(answer.outcome, RequestOutcome::kFailed);
  EXPECT_THAT(answer.reply->message, testing::HasSubstr("[10, 1000]"));
}

}  // namespace
}  // namespace telltale
