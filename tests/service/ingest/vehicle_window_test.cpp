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

}  // namespace
}  // namespace telltale
