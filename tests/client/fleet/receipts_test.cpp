#include "telltale/client/fleet/receipts.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "support/loopback_domain.hpp"
#include "telltale/client/bus/writer.hpp"
#include "telltale/idl/codec/wire/quality.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// A daemon that says what it is told to say, every 20 ms while it lives.
class ReceiptsTest : public testing::Test {
 protected:
  void Report(const std::string& vehicle_id, std::uint64_t accepted, std::uint64_t lost,
              std::uint64_t headings_shed) {
    Quality quality;
    quality.vehicle_id = vehicle_id;
    quality.accepted = accepted;
    quality.lost = lost;
    quality.shed = {0, headings_shed, 0};
    quality.rejected = {{"gnss", "DUPLICATE", 2}};
    writer_.Write(Encode(quality));
  }

  /// Reports the counts again and again, since nobody may be connected at first.
  std::jthread Reporting(const std::string& vehicle_id, std::uint64_t accepted,
                         std::uint64_t lost = 0, std::uint64_t headings_shed = 0) {
    return std::jthread([=, this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        Report(vehicle_id, accepted, lost, headings_shed);
        Quality round_end;
        round_end.vehicle_id = kUnattributed;
        writer_.Write(Encode(round_end));
        std::this_thread::sleep_for(20ms);
      }
    });
  }

  LoopbackDomain domain_;
  Participant here_{domain_.id()};
  Writer<telltale_wire_Quality> writer_{here_};
};

TEST_F(ReceiptsTest, CountsFromTheFirstReport) {
  Receipts receipts(here_, "boat");
  {
    const auto before = Reporting("boat", 100, 3);
    ASSERT_TRUE(receipts.Begin(10s));
    EXPECT_EQ(receipts.Accounted(), 0u);
  }
  const auto after = Reporting("boat", 130, 8);
  EXPECT_TRUE(receipts.WaitFor(35, 10s));
  EXPECT_EQ(receipts.Accounted(), 35u);
  EXPECT_EQ(receipts.Lost(), 5u);
}

TEST_F(ReceiptsTest, AccountsForWhatTheDaemonSheds) {
  Receipts receipts(here_, "boat");
  {
    const auto before = Reporting("boat", 100, 0, 7);
    ASSERT_TRUE(receipts.Begin(10s));
  }
  const auto after = Reporting("boat", 110, 0, 12);
  EXPECT_TRUE(receipts.WaitFor(15, 10s));
  EXPECT_EQ(receipts.Shed(), 5u);
  EXPECT_EQ(receipts.Lost(), 0u);
}

TEST_F(ReceiptsTest, WaitsInVainForWhatNobodyTakes) {
  Receipts receipts(here_, "boat");
  const auto reporting = Reporting("boat", 100);
  ASSERT_TRUE(receipts.Begin(10s));
  EXPECT_FALSE(receipts.WaitFor(1, 200ms));
  receipts.WriteOff(1);
  EXPECT_TRUE(receipts.WaitFor(1, 200ms));
  EXPECT_EQ(receipts.Lost(), 1u);
}

TEST_F(ReceiptsTest, ASampleWrittenOffAndThenSeenMissingIsLostOnce) {
  Receipts receipts(here_, "boat");
  {
    const auto before = Reporting("boat", 100);
    ASSERT_TRUE(receipts.Begin(10s));
  }
  receipts.WriteOff(2);
  const auto after = Reporting("boat", 105, 2);
  EXPECT_TRUE(receipts.WaitFor(7, 10s));
  EXPECT_EQ(receipts.Accounted(), 7u);
  EXPECT_EQ(receipts.Lost(), 2u);
}

TEST_F(ReceiptsTest, AVehicleThatIsNotServedHasNone) {
  Receipts receipts(here_, "boat");
  const auto reporting = Reporting("another", 100);
  EXPECT_FALSE(receipts.Begin(30s));
}

}  // namespace
}  // namespace telltale
