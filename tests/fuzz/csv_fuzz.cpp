#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "insist.hpp"
#include "memory_file.hpp"
#include "telltale/client/recording/csv/mapped_csv.hpp"
#include "telltale/client/recording/csv/numeric_csv.hpp"

namespace {

using telltale::Insist;
using telltale::MemoryFile;

const telltale::Mapping& ColumnsOfTheSeeds() {
  static const telltale::Mapping mapping = [] {
    telltale::Mapping columns;
    columns.name = "columns";
    columns.positions.latitude = "lat";
    columns.positions.longitude = "lon";
    columns.positions.time = {"t", 1e-3, false};
    columns.headings.field = "yaw";
    columns.headings.time = columns.positions.time;
    columns.port.field = "left";
    columns.port.time = columns.positions.time;
    columns.starboard.field = "right";
    columns.starboard.time = columns.positions.time;
    return columns;
  }();
  return mapping;
}

std::size_t LinesIn(const std::uint8_t* data, std::size_t size) {
  std::size_t lines = 1;
  for (std::size_t i = 0; i < size; ++i) lines += data[i] == '\n' ? 1 : 0;
  return lines;
}

}  // namespace

/// No line makes more than a sample of each channel, and what is refused says why.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file({data, size});
  const std::size_t lines = LinesIn(data, size);
  std::size_t rows = 0;
  constexpr std::array<std::string_view, 2> kColumns = {"t", "yaw"};
  const auto read = telltale::ReadCsv(file.Path(), kColumns, [&](std::span<const double> values) {
    Insist(values.size() == kColumns.size());
    ++rows;
  });
  Insist(read ? rows + read->count <= lines : !read.error().reason.empty());

  const auto log = telltale::ReadMappedCsv(file.Path(), ColumnsOfTheSeeds());
  if (!log) {
    Insist(!log.error().reason.empty());
  } else {
    Insist(log->gnss.size() + log->heading.size() + log->thrusters.size() <= 4 * lines);
  }
  return 0;
}
