#include "telltale/idl/codec/wire/read.hpp"

#include "telltale/idl/codec/vehicle_file.hpp"

namespace telltale::wire {

void Reject(std::string field, std::string value, std::string allowed) {
  throw Malformed{{std::move(field), std::move(value), std::move(allowed)}};
}

CodecError IdentifierError(std::string field, std::string_view value) {
  constexpr std::size_t kIdentifierBound = 64;
  std::string shown;
  for (const char c : value.substr(0, kIdentifierBound)) {
    shown += c >= ' ' && c <= '~' ? c : '?';
  }
  if (value.size() > kIdentifierBound) shown += "... (too long or not terminated)";
  return {std::move(field), std::move(shown), std::string(kVehicleIdAllowed)};
}

std::string ReadIdentifier(std::string field, std::string_view text) {
  if (!IsVehicleId(text)) throw Malformed{IdentifierError(std::move(field), text)};
  return std::string(text);
}

double ReadWithin(std::string field, double value, FieldRange range) {
  if (range.Contains(value)) return value;
  Reject(std::move(field), NumberText(value), range.Text());
}

Tally ReadTally(std::string field, std::uint64_t held, std::uint64_t total) {
  if (held > total) {
    Reject(std::move(field), std::to_string(held),
           "not above the total of " + std::to_string(total));
  }
  return {held, total};
}

std::vector<double> ReadNumbers(const char* field, const dds_sequence_double& wire) {
  std::vector<double> numbers(wire._length);
  for (std::uint32_t i = 0; i < wire._length; ++i) {
    numbers[i] = ReadWithin(field, wire._buffer[i], kFinite);
  }
  return numbers;
}

}  // namespace telltale::wire
