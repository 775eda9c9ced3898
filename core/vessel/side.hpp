#pragma once

namespace telltale {

/// Of a boat: port is left.
enum class Side { kPort, kStarboard };

}  // namespace telltale
