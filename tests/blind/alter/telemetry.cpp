#include "alter/telemetry.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace blind::alter {
namespace {

constexpr const char* kFixHeader = "time_s,latitude_deg,longitude_deg";
constexpr const char* kHeadingHeader = "time_s,heading_deg";
constexpr const char* kPulsesHeader = "time_s,left_us,right_us";

template <std::size_t kColumns>
std::optional<std::array<double, kColumns>> Numbers(std::string_view line) {
  std::array<double, kColumns> numbers{};
  const char* at = line.data();
  const char* const end = at + line.size();
  for (std::size_t column = 0; column < kColumns; ++column) {
    if (column > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [rest, error] = std::from_chars(at, end, numbers[column]);
    if (error != std::errc()) return std::nullopt;
    at = rest;
  }
  return at == end ? std::optional(numbers) : std::nullopt;
}

std::string_view WithoutReturn(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

template <std::size_t kColumns, typename Take>
void ReadRows(const std::filesystem::path& file, const char* header, std::size_t& left_out,
              Take take) {
  std::ifstream stream(file);
  if (!stream) throw std::invalid_argument("cannot read " + file.string());
  std::string line;
  if (!std::getline(stream, line) || WithoutReturn(line) != header) {
    throw std::invalid_argument(file.string() + ": the first line should be " + header);
  }
  std::size_t taken = 0;
  while (std::getline(stream, line)) {
    const auto numbers = Numbers<kColumns>(WithoutReturn(line));
    left_out += numbers ? 0 : 1;
    taken += numbers ? 1 : 0;
    if (numbers) take(*numbers);
  }
  if (taken == 0) throw std::invalid_argument(file.string() + " has no rows of numbers");
}

class CsvFile {
 public:
  CsvFile(const std::filesystem::path& path, const char* header) : path_(path), stream_(path) {
    stream_ << header << '\n';
  }
  template <typename... Values>
  void Row(const char* format, Values... values) {
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(), format, values...);
    stream_ << line.data();
  }
  void Close() {
    stream_.close();
    if (!stream_) throw std::runtime_error("cannot write " + path_.string());
  }

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

}  // namespace

Telemetry ReadTelemetry(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::invalid_argument(folder.string() +
                                " is no folder; DataFlash .BIN logs are not read here");
  }
  Telemetry telemetry;
  ReadRows<3>(folder / "gnss.csv", kFixHeader, telemetry.rows_left_out, [&](const auto& row) {
    telemetry.fixes.push_back({row[0], row[1], row[2]});
  });
  ReadRows<2>(folder / "heading.csv", kHeadingHeader, telemetry.rows_left_out,
              [&](const auto& row) {
                telemetry.headings.push_back({row[0], row[1]});
              });
  ReadRows<3>(folder / "thrusters.csv", kPulsesHeader, telemetry.rows_left_out,
              [&](const auto& row) {
                telemetry.pulses.push_back({row[0], row[1], row[2]});
              });
  return telemetry;
}

void WriteTelemetry(const Telemetry& telemetry, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  CsvFile gnss(folder / "gnss.csv", kFixHeader);
  for (const Fix& fix : telemetry.fixes) {
    gnss.Row("%.6f,%.10f,%.10f\n", fix.time_s, fix.latitude_deg, fix.longitude_deg);
  }
  gnss.Close();
  CsvFile heading(folder / "heading.csv", kHeadingHeader);
  for (const Heading& row : telemetry.headings) {
    heading.Row("%.6f,%.6f\n", row.time_s, row.heading_deg);
  }
  heading.Close();
  CsvFile thrusters(folder / "thrusters.csv", kPulsesHeader);
  for (const Pulses& row : telemetry.pulses) {
    thrusters.Row("%.6f,%.3f,%.3f\n", row.time_s, row.left_us, row.right_us);
  }
  thrusters.Close();
}

}  // namespace blind::alter
