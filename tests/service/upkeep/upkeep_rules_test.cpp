#include "telltale/service/upkeep/upkeep_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace telltale {
namespace {

using ::testing::HasSubstr;

constexpr double kStart = 1.7e9;
constexpr double kDay = 86400.0;

UpkeepSettings Acting() {
  UpkeepSettings settings;
  settings.refresh = RefreshMode::kAct;
  return settings;
}

UpkeepFacts ModelOf(double published_unix_s, double drift_since_unix_s = 0.0) {
  return {true, 4, published_unix_s, drift_since_unix_s, 120.0, 0};
}

TEST(UpkeepRules, AskForNothingWhereNothingIsConfigured) {
  UpkeepRules rules(UpkeepSettings(), kStart);
  const auto step = rules.Consider("a", ModelOf(kStart - 400.0 * kDay, kStart), kStart + kDay);
  EXPECT_EQ(step.refresh, "");
  EXPECT_FALSE(step.diagnose);
}

TEST(UpkeepRules, RefreshOldModelsAndBoatsWithoutOne) {
  auto settings = Acting();
  settings.refresh_older_than_s = 7.0 * kDay;
  UpkeepRules rules(settings, kStart);
  EXPECT_EQ(rules.Consider("a", ModelOf(kStart - 6.9 * kDay), kStart).refresh, "");
  EXPECT_EQ(rules.Consider("a", ModelOf(kStart - 7.1 * kDay), kStart).refresh,
            "its model is 7 d old");
  EXPECT_EQ(rules.Consider("b", {.has_telemetry = true}, kStart).refresh, "it has no model");
  EXPECT_EQ(rules.Consider("c", {.has_telemetry = false}, kStart).refresh, "");
}

TEST(UpkeepRules, TryAgainAfterTheRetryTimeOnly) {
  auto settings = Acting();
  settings.refresh_older_than_s = 7.0 * kDay;
  settings.retry_s = 600.0;
  UpkeepRules rules(settings, kStart);
  const UpkeepFacts old = ModelOf(kStart - 8.0 * kDay);
  EXPECT_NE(rules.Consider("a", old, kStart).refresh, "");
  EXPECT_EQ(rules.Consider("a", old, kStart + 599.0).refresh, "");
  EXPECT_NE(rules.Consider("b", old, kStart + 599.0).refresh, "");
  EXPECT_NE(rules.Consider("a", old, kStart + 600.0).refresh, "");
  // A clock that is put back by a month does not end upkeep for a month.
  EXPECT_NE(rules.Consider("a", ModelOf(kStart - 40.0 * kDay), kStart - 30.0 * kDay).refresh, "");
}

TEST(UpkeepRules, RefreshOnceInEachPeriodOfTheSchedule) {
  auto settings = Acting();
  settings.refresh_every_s = kDay;
  settings.retry_s = 1.0;
  UpkeepRules rules(settings, kStart);
  int refreshes = 0;
  for (double hours = 0.0; hours < 24.0 * 10.0; hours += 0.5) {
    const double now = kStart + 3600.0 * hours;
    if (!rules.Consider("a", ModelOf(now), now).refresh.empty()) ++refreshes;
  }
  EXPECT_EQ(refreshes, 9);  // none at the start itself
}

TEST(UpkeepRules, RefreshWhatDrifts) {
  auto settings = Acting();
  settings.refresh_on_drift = true;
  UpkeepRules rules(settings, kStart);
  EXPECT_EQ(rules.Consider("a", ModelOf(kStart), kStart).refresh, "");
  EXPECT_THAT(rules.Consider("a", ModelOf(kStart, kStart), kStart).refresh,
              HasSubstr("revision 4 no longer matches"));
}

TEST(UpkeepRules, DiagnoseADriftOnceAndBeforeTheRefreshThatEndsIt) {
  auto settings = Acting();
  settings.refresh_on_drift = true;
  settings.diagnose_on_drift = true;
  settings.retry_s = 600.0;
  UpkeepRules rules(settings, kStart);
  UpkeepFacts drifting = ModelOf(kStart, kStart);
  const auto first = rules.Consider("a", drifting, kStart);
  EXPECT_TRUE(first.diagnose);
  EXPECT_EQ(first.refresh, "");
  EXPECT_FALSE(rules.Consider("a", drifting, kStart + 1.0).diagnose);
  drifting.diagnosed_revision = drifting.revision;
  const auto later = rules.Consider("a", drifting, kStart + 30.0);
  EXPECT_FALSE(later.diagnose);
  EXPECT_NE(later.refresh, "");
  // One that never ends holds up nothing.
  drifting.diagnosed_revision = 0;
  EXPECT_TRUE(rules.Consider("b", drifting, kStart).diagnose);
  EXPECT_EQ(rules.Consider("b", drifting, kStart + 599.0).refresh, "");
  EXPECT_NE(rules.Consider("b", drifting, kStart + 600.0).refresh, "");
  // It waits for data of the boat as it is now, and so does the refresh.
  drifting.drift_lasts_s = 80.0;
  EXPECT_FALSE(rules.Consider("c", drifting, kStart + 10.0).diagnose);
  EXPECT_EQ(rules.Consider("c", drifting, kStart + 10.0).refresh, "");
  drifting.drift_lasts_s = 90.0;
  EXPECT_TRUE(rules.Consider("c", drifting, kStart + 20.0).diagnose);
  // The drift of the next model is another.
  drifting.revision = 5;
  EXPECT_TRUE(rules.Consider("b", drifting, kStart + 700.0).diagnose);
}

}  // namespace
}  // namespace telltale
