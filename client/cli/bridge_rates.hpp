#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/bridge/live_source.hpp"
#include "telltale/core/data/samples.hpp"

namespace telltale {

/// What has gone through of one vehicle.
struct BridgedVehicle {
  std::string vehicle_id;
  std::array<std::uint64_t, kChannels.size()> published{};
  std::string losses;  ///< for people: "3 lost, 0 rejected"
};

/// What a bridge says on standard error: events, each a line, and on a terminal the rates of each
/// vehicle, drawn anew in place every two seconds.
class BridgeRates {
 public:
  BridgeRates();

  void EachSecond(const std::vector<BridgedVehicle>& vehicles);
  void Report(const std::string& what) const;
  void Erase() const;  ///< the rates

 private:
  std::string TextOf(const BridgedVehicle& now) const;

  bool on_terminal_;
  int seconds_ = 0;
  std::vector<BridgedVehicle> before_;
};

/// Runs a source until SIGINT or SIGTERM; `vehicles` says what has gone through.
void RunUntilSignal(LiveSource& source, BridgeRates& rates,
                    const std::function<std::vector<BridgedVehicle>()>& vehicles);

/// The sum of all counts.
std::uint64_t Total(const auto& counts) {
  std::uint64_t total = 0;
  for (const std::uint64_t count : counts) total += count;
  return total;
}

/// "boat-1: 3 unreadable messages" as a line; empty where the count is zero.
std::string CountNote(const std::string& whose, std::uint64_t count, std::string_view what);

}  // namespace telltale
