#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <dds/dds.h>

#include "telltale/core/uncertainty/coverage.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/codec/field_reader.hpp"

/// How values get out of the generated C structs, checked. Private to idl/codec/wire.
namespace telltale::wire {

/// Ends the decoding of a message at its first fault. Guarded() catches it.
struct Malformed {
  CodecError error;
};

[[noreturn]] void Reject(std::string field, std::string value, std::string allowed);

/// What `read` returns, or the fault that it meets.
template <class Read>
auto Guarded(Read read) -> Decoded<decltype(read())> {
  try {
    return read();
  } catch (Malformed& malformed) {
    return tl::unexpected(std::move(malformed.error));
  }
}

/// The text of a string field. A bounded string, which is an array, ends at its terminator, or at
/// its bound where it has none. An unbounded string, which is a pointer, reads as empty where it is
/// null: the type of the writer lacks the field.
std::string_view View(const auto& text) {
  if constexpr (std::is_array_v<std::remove_reference_t<decltype(text)>>) {
    return {text, strnlen(text, sizeof text)};
  } else {
    return text == nullptr ? std::string_view() : std::string_view(text);
  }
}

std::string TextOf(const auto& text) {
  return std::string(View(text));
}

/// The fault of an identifier. Its value shows '?' for characters that no terminal should print.
CodecError IdentifierError(std::string field, std::string_view value);

/// Refuses what is not IsVehicleId().
std::string ReadIdentifier(std::string field, std::string_view text);

std::string ReadIdentifier(std::string field, const auto& text) {
  return ReadIdentifier(std::move(field), View(text));
}

/// Refuses NaN and values outside the range.
double ReadWithin(std::string field, double value, FieldRange range);

/// A count of `held` cases among `total`. Refuses more than `total`.
Tally ReadTally(std::string field, std::uint64_t held, std::uint64_t total);

/// Finite numbers.
std::vector<double> ReadNumbers(const char* field, const dds_sequence_double& wire);

/// The enumerator of that name among `allowed`.
template <class Allowed>
auto ReadName(std::string field, std::string_view name, const Allowed& allowed) {
  for (const auto candidate : allowed) {
    if (Name(candidate) == name) return candidate;
  }
  std::string names;
  for (const auto candidate : allowed) {
    names.append(names.empty() ? "one of " : ", ").append(Name(candidate));
  }
  Reject(std::move(field), std::string(name), std::move(names));
}

/// As ReadName, but an empty name reads as the unknown enumerator.
template <class Allowed>
auto ReadOptionalName(std::string field, std::string_view name, const Allowed& allowed) {
  using Enum = typename Allowed::value_type;
  return name.empty() ? Enum::kUnknown : ReadName(std::move(field), name, allowed);
}

/// Every element through `read(its field, element)`.
template <class Sequence, class Read>
auto ReadSequence(const std::string& field, const Sequence& sequence, Read read) {
  std::vector<decltype(read(field, sequence._buffer[0]))> items;
  items.reserve(sequence._length);
  for (std::uint32_t i = 0; i < sequence._length; ++i) {
    items.push_back(read(field + "[" + std::to_string(i) + "]", sequence._buffer[i]));
  }
  return items;
}

/// The one element of a sequence through `read(its field, element)`, or nothing. Refuses several.
template <class Sequence, class Read>
auto ReadOptional(const std::string& field, const Sequence& sequence, Read read)
    -> std::optional<decltype(read(field, sequence._buffer[0]))> {
  if (sequence._length > 1) {
    Reject(field, std::to_string(sequence._length) + " items", "none or one");
  }
  if (sequence._length == 0) return std::nullopt;
  return read(field + "[0]", sequence._buffer[0]);
}

}  // namespace telltale::wire
