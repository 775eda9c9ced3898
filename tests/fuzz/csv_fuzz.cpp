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

telltale::Mapping ColumnsOfTheSeeds() {
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
}

/// Metres of any origin, a quaternion and times in seconds and nanoseconds, over the same columns.
telltale::Mapping OtherFormsOfTheSeeds() {
  telltale::Mapping columns;
  columns.name = "other forms";
  columns.positions.latitude = "north";
  columns.positions.longitude = "east";
  columns.positions.is_metres = true;
  columns.positions.held = true;
  columns.positions.time = {"stamp", 1.0, true};
  columns.headings.field = "q";
  columns.headings.is_quaternion = true;
  columns.headings.is_east_north_up = true;
  columns.headings.held = true;
  columns.headings.time = columns.positions.time;
  columns.port = {"", columns.positions.time, "left", false, 250.0, -180.0};
  columns.starboard = {"", columns.positions.time, "right", false, 250.0, -180.0};
  return columns;
}

std::size_t LinesIn(const std::uint8_t* data, std::size_t size) {
  std::size_t lines = 1;
  for (std::size_t i = 0; i < size; ++i) lines += data[i] == '\n' ? 1 : 0;
  return lines;
}

void InsistOnMapped(const MemoryFile& file, const telltale::Mapping& mapping, std::size_t lines) {
  const auto log = telltale::ReadMappedCsv(file.Path(), mapping);
  if (!log) {
    Insist(!log.error().reason.empty());
    return;
  }
  Insist(!log->summary.empty());
  Insist(log->gnss.size() + log->heading.size() + log->thrusters.size() <= 4 * lines);
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

  static const std::array mappings = {ColumnsOfTheSeeds(), OtherFormsOfTheSeeds()};
  for (const telltale::Mapping& mapping : mappings) InsistOnMapped(file, mapping, lines);
  return 0;
}
