#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "any_mapping.hpp"
#include "telltale/client/recording/rosbag1/rosbag1.hpp"

namespace {

void Insist(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// Blocks change nothing, and every outcome can be put into words.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telltale::SourceOptions options;
  if (size % 2 == 0) options.port_channel = 16;
  if (size % 5 < 2) options.mapping = telltale::AnyMapping();
  const telltale::SourceLog whole = telltale::ParseRosbag1({data, size}, size + 1, options);
  const telltale::SourceLog parts = telltale::ParseRosbag1({data, size}, 1 + size % 300, options);
  Insist(!whole.summary.empty());
  Insist(whole.summary == parts.summary);
  Insist(whole.gnss.size() == parts.gnss.size() && whole.heading.size() == parts.heading.size() &&
         whole.thrusters.size() == parts.thrusters.size());
  const auto lacks = whole.Lacks();
  Insist(!lacks || !lacks->reason.empty());
  return 0;
}
