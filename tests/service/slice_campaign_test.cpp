#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "service/shared_fleet_fixture.hpp"
#include "telltale/client/fleet/subscriber.hpp"
#include "telltale/core/base/random.hpp"

namespace telltale {
namespace {

using namespace std::chrono_literals;

/// Four daemons, of which one is killed again and again.
class SliceCampaign : public SharedFleetTest {
 protected:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kDaemons = 4;
  static constexpr auto kUnderWay = 500ms;  ///< in which reports of the dead still arrive

  SliceCampaign() : SharedFleetTest(32) {
    for (std::size_t i = 0; i < kDaemons; ++i) daemons_[i] = StartNamed(NameOf(i));
  }

  static std::string NameOf(std::size_t daemon) { return "daemon-" + std::to_string(daemon); }

  /// TELLTALE_KILLS says how often.
  static int Wanted() {
    const char* wanted = std::getenv("TELLTALE_KILLS");  // NOLINT(concurrency-mt-unsafe)
    return wanted == nullptr ? 3 : std::max(1, std::atoi(wanted));
  }

  /// The boats of each owner whose leases have not run out.
  std::map<std::string, std::vector<std::string>> BoatsByOwner() const {
    std::map<int, std::string> owners;
    leases_->Query(
        "SELECT slice, owner FROM slices WHERE until_unix_s > EXTRACT(EPOCH FROM "
        "clock_timestamp())",
        {}, [&](const Row& row) {
          owners[static_cast<int>(row.Integer("slice"))] = row.Text("owner");
        });
    std::map<std::string, std::vector<std::string>> boats;
    if (owners.size() < kFleetSlices) return boats;
    for (const std::string& boat : boats_) boats[owners.at(SliceOf(boat))].push_back(boat);
    return boats;
  }

  /// Handles reports until every daemon has a quarter of the slices.
  void AwaitQuarters() {
    const auto quarters = [this] {
      std::map<std::string, int> held;
      leases_->Query(
          "SELECT owner FROM slices WHERE until_unix_s > EXTRACT(EPOCH FROM clock_timestamp())", {},
          [&](const Row& row) { ++held[row.Text("owner")]; });
      return held.size() == kDaemons && std::ranges::all_of(held, [](const auto& owner) {
               return owner.second == kFleetSlices / static_cast<int>(kDaemons);
             });
    };
    while (!quarters()) qualities_.Wait(200ms);
  }

  /// Until every one of the boats is reported on after `since`.
  void AwaitReports(const std::vector<std::string>& boats, Clock::time_point since) {
    const auto heard = [&](const std::string& boat) { return heard_[boat] > since; };
    while (!std::ranges::all_of(boats, heard)) qualities_.Wait(200ms);
  }

  std::array<std::unique_ptr<Process>, kDaemons> daemons_;
  std::unique_ptr<Database> leases_ = Storage().Open(SlicesSchema());
  std::map<std::string, Clock::time_point> heard_;  ///< by boat: its newest report
  Participant participant_{domain_.id()};
  QualitySubscriber qualities_{
      participant_, [this](const Quality& quality) { heard_[quality.vehicle_id] = Clock::now(); },
      [](const CodecError& error) { ADD_FAILURE() << error.Message(); }};
};

TEST_F(SliceCampaign, LeavesNoBoatAloneAndNoneToTwo) {
  RandomEngine random(20);
  std::vector<double> silent_s;
  for (int kill = 0; kill < Wanted(); ++kill) {
    AwaitQuarters();
    AwaitReports(boats_, Clock::now());
    const std::size_t victim = random() % kDaemons;
    std::vector<std::string> orphans;
    for (const auto& [owner, boats] : BoatsByOwner()) {
      if (owner.ends_with(NameOf(victim))) orphans = boats;
    }
    daemons_[victim]->Signal(SIGKILL);
    daemons_[victim]->Wait();
    const auto killed = Clock::now();
    AwaitReports(orphans, killed + kUnderWay);
    silent_s.push_back(std::chrono::duration<double>(Clock::now() - killed).count());
    daemons_[victim] = StartNamed(NameOf(victim));
  }
  std::ranges::sort(silent_s);
  std::cout << fmt::format(
      "{} kills of one of {} daemons, leases of {} s\nuntil every boat is served again, s: median "
      "{:.2f}, worst {:.2f}\nleases that overlap: {}\n",
      silent_s.size(), kDaemons, kLeaseS, silent_s[silent_s.size() / 2], silent_s.back(),
      OverlappingLeases());
  EXPECT_EQ(OverlappingLeases(), 0);
}

}  // namespace
}  // namespace telltale
