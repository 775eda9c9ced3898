#include "telltale/client/recording/thruster_sides.hpp"

#include <cstddef>

namespace telltale {

std::vector<ThrusterSample> JoinSides(const std::vector<SideCommand>& port,
                                      const std::vector<SideCommand>& starboard) {
  std::vector<ThrusterSample> joined;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < port.size() || j < starboard.size()) {
    double time_s = 0.0;
    if (j == starboard.size() || (i < port.size() && port[i].time_s <= starboard[j].time_s)) {
      time_s = port[i++].time_s;
      if (j < starboard.size() && starboard[j].time_s == time_s) ++j;
    } else {
      time_s = starboard[j++].time_s;
    }
    if (i > 0 && j > 0) {
      joined.push_back({time_s, port[i - 1].pulse_us, starboard[j - 1].pulse_us});
    }
  }
  return joined;
}

}  // namespace telltale
