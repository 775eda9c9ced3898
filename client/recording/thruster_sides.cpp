#include "telltale/client/recording/thruster_sides.hpp"

#include <algorithm>
#include <cstddef>

namespace telltale {
namespace {

constexpr double kClockSetBackS = 60.0;

/// The first command from `begin` on before which the clock was set back.
std::size_t EndOfClock(const std::vector<SideCommand>& commands, std::size_t begin) {
  std::size_t end = std::min(begin + 1, commands.size());
  while (end < commands.size() &&
         commands[end].time_s >= commands[end - 1].time_s - kClockSetBackS) {
    ++end;
  }
  return end;
}

}  // namespace

void SideJoiner::Take(Side side, const SideCommand& command, const Emit& emit) {
  if (waiting_s_ != command.time_s) Finish(emit);
  waiting_s_ = command.time_s;
  (side == Side::kPort ? port_ : starboard_) = {command.pulse_us, true, true};
  if (port_.now && starboard_.now) Finish(emit);
}

void SideJoiner::Finish(const Emit& emit) {
  const bool waits = port_.now || starboard_.now;
  if (waits && port_.ever && starboard_.ever) {
    emit({waiting_s_, port_.pulse_us, starboard_.pulse_us});
  }
  port_.now = starboard_.now = false;
}

std::vector<ThrusterSample> JoinSides(const std::vector<SideCommand>& port,
                                      const std::vector<SideCommand>& starboard) {
  std::vector<ThrusterSample> joined;
  const SideJoiner::Emit keep = [&](const ThrusterSample& sample) { joined.push_back(sample); };
  SideJoiner joiner;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < port.size() || j < starboard.size()) {
    const std::size_t port_end = EndOfClock(port, i);
    const std::size_t starboard_end = EndOfClock(starboard, j);
    while (i < port_end || j < starboard_end) {
      if (j == starboard_end || (i < port_end && port[i].time_s <= starboard[j].time_s)) {
        joiner.Take(Side::kPort, port[i++], keep);
      } else {
        joiner.Take(Side::kStarboard, starboard[j++], keep);
      }
    }
  }
  joiner.Finish(keep);
  return joined;
}

}  // namespace telltale
