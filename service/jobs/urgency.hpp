#pragma once

#include <array>
#include <cstddef>

namespace telltale {

/// How soon a request is worked on. Each has workers of its own, so that none waits for another,
/// and the less urgent ones leave the processors to the more urgent ones.
enum class Urgency {
  kInteractive,  ///< somebody waits for the answer
  kRefresh,      ///< a part of a refresh of many vehicles
  kBackground,   ///< a coverage check, which takes minutes
};

inline constexpr std::array kUrgencies = {Urgency::kInteractive, Urgency::kRefresh,
                                          Urgency::kBackground};

/// How many threads work on the requests of each urgency. None: such requests are not taken.
struct Workers {
  std::size_t interactive = 1;
  std::size_t refresh = 0;
  std::size_t background = 0;

  std::size_t Of(Urgency urgency) const {
    switch (urgency) {
      case Urgency::kInteractive: return interactive;
      case Urgency::kRefresh: return refresh;
      case Urgency::kBackground: break;
    }
    return background;
  }
};

/// Lets the calling thread, and those that it starts from now on, leave the processors to threads
/// of a greater urgency. Where those take all there is, a refresh still gets a tenth of the time
/// that one of them gets, and a coverage check a seventieth. Called once a thread, which had the
/// nice value of the daemon.
void YieldToMoreUrgentThan(Urgency urgency);

}  // namespace telltale
