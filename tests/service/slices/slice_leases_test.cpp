#include "telltale/service/slices/slice_leases.hpp"

#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/storage_fixture.hpp"
#include "support/made_up_identifications.hpp"
#include "telltale/service/models/model_store.hpp"
#include "telltale/service/storage/server_clock.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_store.hpp"

namespace telltale {
namespace {

constexpr double kLong = 600.0;  // seconds, longer than any test
constexpr double kShort = 0.05;

class SliceLeasesTest : public ::testing::Test {
 protected:
  /// Of one more daemon.
  telltale::Storage Shared() const {
    return telltale::Storage(engine_.Folder().Path(), engine_.Address(),
                             telltale::Storage::Writes::kNeedLeases);
  }

  /// Once the leases of others have run out.
  static Slices ClaimAll(SliceLeases& leases) {
    Slices claimed;
    while (claimed.size() < kFleetSlices) claimed.merge(leases.Claim(kFleetSlices));
    return claimed;
  }

  EngineStorage engine_{Engine::kPostgres};
  telltale::Storage storage_ = Shared();
};

TEST(SliceOf, IsTheSameOnEveryMachineAndSpreadsTheFleet) {
  // python3 -c 'import zlib; print(zlib.crc32(b"yellowfish") % 64, zlib.crc32(b"boat-7") % 64)'
  EXPECT_EQ(SliceOf("yellowfish"), 21);
  EXPECT_EQ(SliceOf("boat-7"), 36);
  std::set<int> used;
  for (int i = 0; i < 1000; ++i) used.insert(SliceOf("boat-" + std::to_string(i)));
  EXPECT_EQ(used.size(), 64u);
}

TEST_F(SliceLeasesTest, GiveEachSliceToOneDaemonAtATime) {
  SliceLeases one(storage_, "one", kLong);
  SliceLeases two(storage_, "two", kLong);
  const Slices first = one.Claim(40);
  EXPECT_EQ(first.size(), 40u);
  const Slices second = two.Claim(kFleetSlices);
  EXPECT_EQ(second.size(), 24u);
  for (const auto& [slice, fence] : second) EXPECT_FALSE(first.contains(slice));
  EXPECT_TRUE(one.Claim(kFleetSlices).empty());
  EXPECT_EQ(one.Renew(), first);
  EXPECT_EQ(one.LiveDaemons(), 1);
  EXPECT_EQ(two.Renew(), second);
  EXPECT_EQ(two.LiveDaemons(), 2);
}

TEST_F(SliceLeasesTest, PassOnWithAGreaterFenceOnceTheyRunOut) {
  SliceLeases dead(storage_, "dead", kShort);
  const Slices held = dead.Claim(kFleetSlices);
  SliceLeases heir(storage_, "heir", kLong);
  const Slices inherited = ClaimAll(heir);
  for (const auto& [slice, fence] : inherited) EXPECT_GT(fence, held.at(slice));
  EXPECT_TRUE(dead.Renew().empty());
  EXPECT_TRUE(dead.Claim(kFleetSlices).empty());
}

TEST_F(SliceLeasesTest, CountADaemonThatRenewsLateAsLive) {
  SliceLeases late(storage_, "late", kShort);
  late.Claim(kFleetSlices);
  late.Renew();
  SliceLeases other(storage_, "other", kLong);
  ClaimAll(other);  // so the lease of the late one has run out
  EXPECT_EQ(late.LiveDaemons(), 1);
  other.Renew();
  EXPECT_EQ(late.LiveDaemons(), 2);
  EXPECT_EQ(other.LiveDaemons(), 1);
}

TEST_F(SliceLeasesTest, AreForgottenAWeekAfterTheyHaveRunOut) {
  const auto database = storage_.Open(SlicesSchema());
  const auto insert = [&](const std::string& owner, std::int64_t fence, double days_ago) {
    const std::string then = fmt::format("{} - {}", kServerNow, days_ago * 86400.0);
    database->Execute("INSERT INTO daemons (owner, until_unix_s) VALUES ($1, " + then + ")",
                      {owner});
    database->Execute(
        "INSERT INTO leases (slice, fence, owner, since_unix_s, until_unix_s)"
        " VALUES (3, $1, $2, 0, " +
            then + ")",
        {fence, owner});
  };
  insert("last month", -2, 30.0);
  insert("yesterday", -1, 1.0);
  const auto owners = [&](const char* table) {
    std::set<std::string> found;
    database->Query(std::string("SELECT owner FROM ") + table, {},
                    [&](const Row& row) { found.insert(row.Text("owner")); });
    return found;
  };
  SliceLeases leases(storage_, "live", kLong);
  leases.Renew();
  leases.Claim(kFleetSlices);
  EXPECT_EQ(owners("leases"), (std::set<std::string>{"yesterday", "live"}));
  EXPECT_EQ(owners("daemons"), (std::set<std::string>{"yesterday", "live"}));
}

TEST_F(SliceLeasesTest, PassOnAtOnceWhereTheyAreReleased) {
  Slices held;
  {
    SliceLeases leaving(storage_, "leaving", kLong);
    held = leaving.Claim(kFleetSlices);
    leaving.Release({3});
    SliceLeases other(storage_, "other", kLong);
    EXPECT_EQ(other.Claim(kFleetSlices), (Slices{{3, held.at(3) + 1}}));
  }
  SliceLeases heir(storage_, "heir", kLong);
  EXPECT_EQ(heir.Claim(kFleetSlices).size(), 64u);
}

TEST_F(SliceLeasesTest, ComeBackToADaemonThatWasKilledAndStartsAgain) {
  auto killed = std::make_unique<SliceLeases>(storage_, "boat house", kLong);
  const Slices held = killed->Claim(kFleetSlices);
  SliceLeases again(storage_, "boat house", kLong);
  const Slices fresh = again.Claim(kFleetSlices);
  ASSERT_EQ(fresh.size(), 64u);
  for (const auto& [slice, fence] : fresh) EXPECT_GT(fence, held.at(slice));
}

// A daemon that was stopped for longer than its leases, and goes on as if nothing had been.
TEST_F(SliceLeasesTest, RefuseTheWritesOfADaemonThatHasLostThem) {
  const telltale::Storage late = Shared();
  ModelStore late_models(late);
  WindowStore late_windows(late);
  SliceLeases late_leases(late, "late", kShort);
  late.held()->Set(late_leases.Claim(kFleetSlices));
  const Identification model = MadeUpIdentification();
  EXPECT_EQ(late_models.Save(model, 1.0, std::nullopt).model.revision, 1u);

  SliceLeases heir(storage_, "heir", kLong);
  storage_.held()->Set(ClaimAll(heir));
  EXPECT_THROW(late_models.Save(model, 2.0, std::nullopt), LeaseLost);
  Recording recording;
  recording.gnss.push_back({1.0, 37.0, -6.0});
  const auto save = [&] { late_windows.Save({{model.vehicle_id, recording}}, {600.0, 1000}); };
  EXPECT_THROW(save(), LeaseLost);
  late.held()->Set({});  // it has heard of it
  EXPECT_THROW(late_models.Save(model, 2.0, std::nullopt), LeaseLost);
  EXPECT_NO_THROW(save());
  EXPECT_EQ(late_windows.Load(model.vehicle_id, [](const Recording&) { ADD_FAILURE(); }), 0u);

  ModelStore models(storage_);
  EXPECT_EQ(models.Save(model, 3.0, std::nullopt).model.revision, 2u);
  EXPECT_EQ(models.Latest(model.vehicle_id)->model.published_unix_s, 3.0);
}

}  // namespace
}  // namespace telltale
