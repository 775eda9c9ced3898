#include <cstddef>
#include <cstdint>

#include "any_blocks.hpp"
#include "any_mapping.hpp"
#include "telltale/client/recording/mcap/mcap_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telltale::SourceOptions options;
  if (size % 3 == 0) options.system_id = 1;
  if (size % 2 == 0) options.port_channel = 16;
  if (size % 5 < 2) options.mapping = telltale::AnyMapping();
  telltale::InsistOnAnyBlocks({data, size}, [&](auto bytes, std::size_t block) {
    return telltale::ParseMcap(bytes, block, options);
  });
  return 0;
}
