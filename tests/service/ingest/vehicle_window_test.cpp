#include "telltale/service/ingest/vehicle_window.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "telltale/core/paper/yellowfish.hpp"

namespace telltale {
namespace {

TEST(VehicleWindow, CountsArrivalsAdmissionsAndLoss) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  window.Add(1, GnssFix{0.0, 37.0, -6.0});
  window.Add(4, GnssFix{60.0, 37.1, -6.0});
  window.Add(1, HeadingSample{30.0, std::nan("")});
  const WindowState state = window.State();
  EXPECT_EQ(state.arrived[0], 2u);
  EXPECT_EQ(state.arrived[1], 1u);
  EXPECT_EQ(state.accepted, 2u);
  EXPECT_EQ(state.lost, 2u);
  EXPECT_EQ(state.rejected.Of(Channel::kHeading, RejectReason::kNotFinite), 1u);
  EXPECT_DOUBLE_EQ(state.fill, 60.0 / WindowLimits().duration_s);
  EXPECT_EQ(window.Snapshot().gnss.size(), 2u);
}

TEST(VehicleWindow, CountsWhatIsShedAsArrivedAndNotAsLost) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  window.Add(1, HeadingSample{0.0, 10.0});
  window.Shed(Channel::kHeading, 2, 0.1);
  window.Shed(Channel::kHeading, 3, 0.2);
  window.Add(4, HeadingSample{0.3, 11.0});
  const WindowState state = window.State();
  EXPECT_EQ(state.arrived[1], 4u);
  EXPECT_EQ(state.shed[1], 2u);
  EXPECT_EQ(state.accepted, 2u);
  EXPECT_EQ(state.lost, 0u);
  EXPECT_EQ(window.Snapshot().heading.size(), 2u);
}

TEST(VehicleWindow, GivesTheEndOfWhatItHolds) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  for (std::uint64_t i = 1; i <= 100; ++i) {
    const auto time_s = static_cast<double>(i);
    window.Add(i, HeadingSample{time_s, time_s});
    if (i % 10 == 0) window.Add(i / 10, GnssFix{time_s, 37.0 + 1e-4 * time_s, -6.0});
    if (i == 50) window.Add(1, ThrusterSample{time_s, 1600.0, 1600.0});
  }
  const Recording end = window.Snapshot(20.0);  // from 80 s
  EXPECT_EQ(end.heading.size(), 21u);
  EXPECT_EQ(end.heading.front().time_s, 80.0);
  EXPECT_EQ(end.gnss.size(), 3u);
  EXPECT_TRUE(end.thrusters.empty());
  EXPECT_EQ(window.Snapshot(1e6).heading.size(), 100u);
}

TEST(VehicleWindow, LosesNothingBetweenThreads) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  constexpr std::uint64_t kSamples = 20000;
  std::jthread reader([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) window.Snapshot();
  });
  for (std::uint64_t i = 1; i <= kSamples; ++i) {
    const double time_s = 0.01 * static_cast<double>(i);
    window.Add(i, HeadingSample{time_s, std::fmod(time_s, 360.0)});
  }
  reader.request_stop();
  reader.join();
  EXPECT_EQ(window.State().accepted, kSamples);
  EXPECT_EQ(window.State().lost, 0u);
}

/// `count` headings, a second apart, from `start_s` of the boat's clock.
void AddHeadings(VehicleWindow& window, double start_s, int count) {
  for (int i = 0; i < count; ++i) window.Add(0, HeadingSample{start_s + i, 10.0 + 0.1 * i});
}

TEST(VehicleWindow, CountsEachJumpOfTheClockOnce) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  AddHeadings(window, 0.0, 20);
  AddHeadings(window, 1000.0, 20);  // ahead
  EXPECT_EQ(window.State().clock_jumps, 1u);
  EXPECT_EQ(window.State().rejected.Of(RejectReason::kClockJump), 4u);
  AddHeadings(window, 1100.0, 4);  // not confirmed
  EXPECT_EQ(window.State().clock_jumps, 1u);
  AddHeadings(window, 20.0, 20);  // back to where it was
  EXPECT_EQ(window.State().clock_jumps, 2u);
}

// It stands for a daemon that starts again: how long the boat has been silent is not known.
TEST(VehicleWindow, CountsNoJumpAfterARestoredWindow) {
  VehicleWindow window(YellowfishVehicle(), WindowLimits());
  Recording saved;
  saved.heading = {{0.0, 10.0}, {1.0, 10.1}};
  window.Restore(saved);
  AddHeadings(window, 1000.0, 20);
  EXPECT_EQ(window.State().clock_jumps, 0u);
}

/// A window whose store is the list `saved`.
class UnloadedWindow : public ::testing::Test {
 protected:
  using Clock = VehicleWindow::Clock;
  static constexpr std::chrono::seconds kUnused{10};

  UnloadedWindow() {
    window_.BeginSaving({.load =
                             [this](const std::string&, const auto& take) {
                               if (is_gone_) throw std::runtime_error("the store is gone");
                               for (const Recording& samples : saved_) take(samples);
                             },
                         .wanted = [this] { ++wanted_; }});
  }

  void Save() { saved_.push_back(window_.TakeUnsaved()); }
  bool Unload() { return window_.UnloadIfUnused(kUnused, Clock::now() + kUnused); }

  std::vector<Recording> saved_;
  bool is_gone_ = false;
  int wanted_ = 0;
  VehicleWindow window_{YellowfishVehicle(), WindowLimits()};
};

TEST_F(UnloadedWindow, IsOneThatNobodyUsesAndThatIsSaved) {
  EXPECT_FALSE(Unload());  // it is empty
  AddHeadings(window_, 0.0, 20);
  EXPECT_FALSE(Unload());  // it is not saved
  Save();
  EXPECT_FALSE(window_.UnloadIfUnused(kUnused, Clock::now()));
  EXPECT_TRUE(Unload());
  EXPECT_TRUE(window_.Saving().unloaded);
  EXPECT_FALSE(Unload());
  window_.Snapshot();
  EXPECT_FALSE(window_.Saving().unloaded);
  EXPECT_FALSE(window_.UnloadIfUnused(kUnused, Clock::now()));  // it is in use again
  EXPECT_EQ(window_.Saving().unsaved, 0u);
}

TEST_F(UnloadedWindow, TellsWhatItDidBefore) {
  AddHeadings(window_, 0.0, 20);
  window_.Add(1, HeadingSample{5.5, std::nan("")});
  Save();
  const WindowState before = window_.State();
  ASSERT_TRUE(Unload());
  const WindowState after = window_.State();
  EXPECT_EQ(after.start_s, before.start_s);
  EXPECT_EQ(after.end_s, before.end_s);
  EXPECT_EQ(after.fill, before.fill);
  EXPECT_EQ(after.accepted, before.accepted);
  EXPECT_EQ(after.rejected.Total(), 1u);
  EXPECT_EQ(after.newest_heading->time_s, before.newest_heading->time_s);
  EXPECT_EQ(after.bytes, 0u);
  EXPECT_EQ(wanted_, 0);
}

TEST_F(UnloadedWindow, ComesBackAsItWasWhenItIsAskedFor) {
  AddHeadings(window_, 0.0, 20);
  Save();
  AddHeadings(window_, 20.0, 20);
  Save();
  const Recording before = window_.Snapshot();
  ASSERT_TRUE(Unload());
  const Recording after = window_.Snapshot();
  ASSERT_EQ(after.heading.size(), before.heading.size());
  for (std::size_t i = 0; i < after.heading.size(); ++i) {
    EXPECT_EQ(after.heading[i].time_s, before.heading[i].time_s);
    EXPECT_EQ(after.heading[i].heading_deg, before.heading[i].heading_deg);
  }
  EXPECT_EQ(window_.State().rejected.Total(), 0u);
}

TEST_F(UnloadedWindow, LosesNothingThatArrivesMeanwhile) {
  AddHeadings(window_, 0.0, 20);
  Save();
  ASSERT_TRUE(Unload());
  AddHeadings(window_, 20.0, 3);
  EXPECT_EQ(wanted_, 3);
  EXPECT_TRUE(window_.WaitsForLoad());
  EXPECT_EQ(window_.State().end_s, 19.0);
  window_.Load();
  EXPECT_FALSE(window_.WaitsForLoad());
  EXPECT_EQ(window_.State().end_s, 22.0);
  EXPECT_EQ(window_.Snapshot().heading.size(), 23u);
  EXPECT_EQ(window_.TakeUnsaved().heading.size(), 3u);
}

TEST_F(UnloadedWindow, StaysUnloadedWhereTheStoreRefuses) {
  AddHeadings(window_, 0.0, 20);
  Save();
  ASSERT_TRUE(Unload());
  is_gone_ = true;
  AddHeadings(window_, 20.0, 3);
  EXPECT_THROW(window_.Snapshot(), std::runtime_error);
  EXPECT_TRUE(window_.TakeUnsaved().heading.empty());
  EXPECT_TRUE(window_.WaitsForLoad());
  is_gone_ = false;
  EXPECT_EQ(window_.Snapshot().heading.size(), 23u);
}

TEST_F(UnloadedWindow, IsTakenOverByThatOfTheChangedVehicle) {
  AddHeadings(window_, 0.0, 20);
  Save();
  ASSERT_TRUE(Unload());
  AddHeadings(window_, 20.0, 3);
  VehicleWindow changed(YellowfishVehicle(), WindowLimits());
  changed.TakeOver(window_);
  EXPECT_TRUE(changed.WaitsForLoad());
  EXPECT_EQ(changed.State().end_s, 19.0);
  EXPECT_EQ(changed.Snapshot().heading.size(), 23u);
  EXPECT_TRUE(window_.Snapshot().heading.empty());
}

}  // namespace
}  // namespace telltale
