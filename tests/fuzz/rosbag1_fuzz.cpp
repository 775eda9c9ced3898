#include <cstddef>
#include <cstdint>

#include "any_blocks.hpp"
#include "any_mapping.hpp"
#include "telltale/client/recording/rosbag1/rosbag1.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telltale::SourceOptions options;
  if (size % 2 == 0) options.port_channel = 16;
  if (size % 5 < 2) options.mapping = telltale::AnyMapping();
  telltale::InsistOnAnyBlocks({data, size}, [&](auto bytes, std::size_t block) {
    return telltale::ParseRosbag1(bytes, block, options);
  });
  return 0;
}
