#include <cstddef>
#include <cstdint>
#include <fstream>

#include "any_mapping.hpp"
#include "insist.hpp"
#include "telltale/client/recording/rosbag2/rosbag2.hpp"
#include "telltale/client/recording/temporary_file.hpp"

/// A database, or MCAP, of any bytes gives a recording or a refusal, each in words. SQLite takes a
/// file by its true path, which one in memory does not have.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const telltale::TemporaryFile file;
  std::ofstream(file.Path(), std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  telltale::SourceOptions options;
  if (size % 2 == 0) options.port_channel = 16;
  if (size % 5 < 2) options.mapping = telltale::AnyMapping();
  const auto log = telltale::ReadRosbag2(file.Path(), options);
  telltale::Insist(log ? !log->summary.empty() : !log.error().reason.empty());
  return 0;
}
