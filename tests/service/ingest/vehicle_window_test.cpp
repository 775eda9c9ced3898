#include "telltale/service/ingest/vehicle_window.hpp"

#include <cmath>
#include <thread>

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

}  // namespace
}  // namespace telltale
