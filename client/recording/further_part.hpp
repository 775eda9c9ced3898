#pragma once

#include <string>

namespace telltale {

/// A part of a summary that follows another: "; thinned to 50 Hz"; empty where there is none.
inline std::string FurtherPart(const std::string& part) {
  return part.empty() ? part : "; " + part;
}

}  // namespace telltale
