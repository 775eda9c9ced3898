#include "telltale/service/windows/window_store.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "service/storage_fixture.hpp"
#include "support/temporary_folder.hpp"
#include "telltale/service/storage/stores.hpp"
#include "telltale/service/windows/window_chunk.hpp"

namespace telltale {
namespace {

constexpr WindowStore::Limits kNoLimits{1e6, 1000};

Recording Seconds(double from_s, int count) {
  Recording recording;
  for (int i = 0; i < count; ++i) {
    const double time_s = from_s + i;
    recording.gnss.push_back({time_s, 37.0 + 1e-5 * i, -6.0});
    recording.heading.push_back({time_s + 0.1, 10.0 * i});
    recording.thrusters.push_back({time_s + 0.2, 1500.0 + i, 1500.0 - i});
  }
  return recording;
}

std::size_t FixesOf(const WindowStore& store, const std::string& vehicle_id) {
  std::size_t fixes = 0;
  store.Load(vehicle_id, [&](const Recording& samples) { fixes += samples.gnss.size(); });
  return fixes;
}

using WindowStoreTest = StorageTest;
INSTANTIATE_TEST_SUITE_P(Engines, WindowStoreTest, kEngines, EngineName);

TEST(WindowChunk, ComesBackBitForBitOrNotAtAll) {
  const Recording packed = Seconds(1.7e9, 100);
  std::string blob = PackChunk(packed);
  const auto unpacked = UnpackChunk(blob);
  ASSERT_TRUE(unpacked);
  ASSERT_EQ(unpacked->gnss.size(), 100u);
  EXPECT_EQ(unpacked->gnss[7].latitude_deg, packed.gnss[7].latitude_deg);
  EXPECT_EQ(unpacked->heading[7].time_s, packed.heading[7].time_s);
  EXPECT_EQ(unpacked->thrusters[7].starboard_us, packed.thrusters[7].starboard_us);
  EXPECT_LT(blob.size(), 100u * 7u * sizeof(double));
  for (std::size_t i = 0; i < blob.size(); ++i) {
    for (const int bit : {0, 5}) {
      std::string flipped = blob;
      flipped[i] = static_cast<char>(flipped[i] ^ (1 << bit));
      EXPECT_FALSE(UnpackChunk(flipped)) << "byte " << i;
    }
  }
  EXPECT_FALSE(UnpackChunk(""));
  EXPECT_FALSE(UnpackChunk(blob.substr(0, blob.size() - 1)));
}

TEST_P(WindowStoreTest, GivesBackEachVehiclesChunksInOrder) {
  WindowStore(Storage()).Save({{"one", Seconds(0.0, 5)}, {"two", Seconds(0.0, 3)}}, kNoLimits);
  WindowStore(Storage()).Save({{"one", Seconds(5.0, 5)}}, kNoLimits);
  const WindowStore store(Storage());
  std::vector<double> starts;
  EXPECT_EQ(
      store.Load("one",
                 [&](const Recording& samples) { starts.push_back(samples.gnss.front().time_s); }),
      0u);
  EXPECT_EQ(starts, (std::vector{0.0, 5.0}));
  EXPECT_EQ(FixesOf(store, "two"), 3u);
  EXPECT_EQ(FixesOf(store, "stranger"), 0u);
}

TEST_P(WindowStoreTest, DropsWhatTheWindowHasDropped) {
  WindowStore store(Storage());
  for (int i = 0; i < 100; ++i) store.Save({{"one", Seconds(5.0 * i, 5)}}, {60.0, 1000});
  // The newest sample is that of 499.2 s.
  EXPECT_GE(FixesOf(store, "one"), 60u);
  EXPECT_LE(FixesOf(store, "one"), 70u);
  // The clock goes back again and again: the count bounds what is kept.
  for (int i = 100; i > 0; --i) store.Save({{"one", Seconds(5.0 * i, 5)}}, {1e6, 20});
  EXPECT_EQ(FixesOf(store, "one"), 20u * 5u);
}

TEST_P(WindowStoreTest, PassesOverADamagedChunk) {
  WindowStore store(Storage());
  for (int i = 0; i < 3; ++i) store.Save({{"one", Seconds(5.0 * i, 5)}}, kNoLimits);
  Storage()
      .Open(WindowsSchema())
      ->Execute("UPDATE chunks SET samples = $1 WHERE number = 2", {Blob("\1\2\3\4\5")});
  std::size_t fixes = 0;
  EXPECT_EQ(store.Load("one", [&](const Recording& samples) { fixes += samples.gnss.size(); }), 1u);
  EXPECT_EQ(fixes, 10u);
}

TEST(SqliteWindowStore, StartsAgainBesideAFileThatIsNoDatabase) {
  const TemporaryFolder folder;
  folder.Write("windows.sqlite", std::string(10000, 'x'));
  WindowStore store(Storage(folder.Path()));
  store.Save({{"one", Seconds(0.0, 5)}}, kNoLimits);
  EXPECT_EQ(FixesOf(store, "one"), 5u);
}

}  // namespace
}  // namespace telltale
