#pragma once

#include <cstdlib>

namespace telltale {

/// What has to hold of every input.
inline void Insist(bool holds) {
  if (!holds) std::abort();
}

}  // namespace telltale
