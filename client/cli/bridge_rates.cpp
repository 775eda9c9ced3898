#include "telltale/client/cli/bridge_rates.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "telltale/client/cli/progress_line.hpp"
#include "telltale/client/cli/stop_on_signal.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

constexpr int kLineEachSeconds = 2;

}  // namespace

BridgeRates::BridgeRates() : on_terminal_(isatty(STDERR_FILENO) != 0) {}

void BridgeRates::EachSecond(const std::vector<BridgedVehicle>& vehicles) {
  if (!on_terminal_ || ++seconds_ % kLineEachSeconds != 0) return;
  std::cerr << kClearLine << (vehicles.empty() ? "no vehicle is heard yet" : "");
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    std::cerr << (i > 0 ? "  |  " : "") << TextOf(vehicles[i]);
  }
  std::cerr << std::flush;
  before_ = vehicles;
}

void BridgeRates::Report(const std::string& what) const {
  Erase();
  std::cerr << what << std::endl;
}

std::string BridgeRates::TextOf(const BridgedVehicle& now) const {
  const auto found = std::ranges::find(before_, now.vehicle_id, &BridgedVehicle::vehicle_id);
  std::string text = now.vehicle_id;
  for (const Channel channel : kChannels) {
    const auto at = static_cast<std::size_t>(channel);
    const std::uint64_t then = found == before_.end() ? 0 : found->published[at];
    const double rate_hz = static_cast<double>(now.published[at] - then) / kLineEachSeconds;
    text += ' ' + std::string(Name(channel)) + ' ' + Fixed(rate_hz, 1) + " Hz";
  }
  return text + ", " + now.losses;
}

void BridgeRates::Erase() const {
  if (on_terminal_) std::cerr << kClearLine << std::flush;
}

void RunUntilSignal(LiveSource& source, BridgeRates& rates,
                    const std::function<std::vector<BridgedVehicle>()>& vehicles) {
  const StopOnSignal stop([&] { source.Stop(); });
  source.Run([&] { rates.EachSecond(vehicles()); });
  rates.Erase();
}

std::string CountNote(const std::string& whose, std::uint64_t count, std::string_view what) {
  return count > 0 ? whose + std::to_string(count) + ' ' + std::string(what) + '\n' : std::string();
}

}  // namespace telltale
