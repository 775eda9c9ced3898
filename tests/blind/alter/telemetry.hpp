#pragma once

#include <filesystem>
#include <vector>

namespace blind::alter {

struct Fix {
  double time_s;
  double latitude_deg;
  double longitude_deg;
};

struct Heading {
  double time_s;
  double heading_deg;
};

struct Pulses {
  double time_s;
  double left_us;
  double right_us;
};

/// A telemetry log folder in memory. Rows that are no numbers are left out and counted.
struct Telemetry {
  std::vector<Fix> fixes;
  std::vector<Heading> headings;
  std::vector<Pulses> pulses;
  std::size_t rows_left_out = 0;
};

/// Reads gnss.csv, heading.csv and thrusters.csv; throws std::invalid_argument naming the file that
/// is missing, has another header or no rows. DataFlash .BIN logs are not read.
Telemetry ReadTelemetry(const std::filesystem::path& folder);

/// Throws std::runtime_error naming the file that cannot be written.
void WriteTelemetry(const Telemetry& telemetry, const std::filesystem::path& folder);

}  // namespace blind::alter
