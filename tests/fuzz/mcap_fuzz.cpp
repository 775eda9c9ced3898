#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>

#include "any_mapping.hpp"
#include "telltale/client/recording/mcap/mcap_recording.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// Blocks change nothing, and every outcome can be put into words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telltale::SourceOptions options;
  if (size % 3 == 0) options.system_id = 1;
  if (size % 2 == 0) options.port_channel = 16;
  if (size % 5 < 2) options.mapping = telltale::AnyMapping();
  const telltale::SourceLog whole = telltale::ParseMcap({data, size}, size + 1, options);
  const telltale::SourceLog parts = telltale::ParseMcap({data, size}, 1 + size % 300, options);
  Insist(!whole.summary.empty());
  if (whole.summary != parts.summary) {
    std::cerr << "at once: " << whole.summary << "\nin parts: " << parts.summary << '\n';
  }
  Insist(whole.summary == parts.summary);
  Insist(whole.gnss.size() == parts.gnss.size() && whole.heading.size() == parts.heading.size() &&
         whole.thrusters.size() == parts.thrusters.size());
  const auto lacks = whole.Lacks();
  Insist(!lacks || !lacks->reason.empty());
  return 0;
}
