#pragma once

#include <cstddef>
#include <cstdint>
#include <iostream>
#include <span>

#include "insist.hpp"
#include "telltale/client/recording/source_log.hpp"

namespace telltale {

/// That the blocks in which bytes arrive change nothing, and that every outcome can be put into
/// words. `parse(bytes, block)` gives a SourceLog.
template <class Parse>
void InsistOnAnyBlocks(std::span<const std::uint8_t> bytes, Parse parse) {
  const SourceLog whole = parse(bytes, bytes.size() + 1);
  const SourceLog parts = parse(bytes, 1 + bytes.size() % 300);
  Insist(!whole.summary.empty());
  if (whole.summary != parts.summary) {
    std::cerr << "at once: " << whole.summary << "\nin parts: " << parts.summary << '\n';
  }
  Insist(whole.summary == parts.summary);
  Insist(whole.gnss.size() == parts.gnss.size() && whole.heading.size() == parts.heading.size() &&
         whole.thrusters.size() == parts.thrusters.size());
  for (const Refusal& lack : whole.Lacks()) Insist(!lack.reason.empty());
}

}  // namespace telltale
