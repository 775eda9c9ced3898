#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include <dds/dds.h>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/validation/promotion.hpp"
#include "telltale/idl/codec/vehicle_file.hpp"

/// How values of C++ get into the generated C structs. Private to idl/codec/wire.
namespace telltale::wire {

/// Copies into a bounded string. Requires a text that fits.
template <std::size_t n>
void Put(char (&target)[n], std::string_view text) {
  Require(text.size() < n, "an identifier that fits its bounded string");
  std::copy(text.begin(), text.end(), target);
  target[text.size()] = '\0';
}

/// Copies into an unbounded string, which the sample then owns.
inline void Put(char*& target, std::string_view text) {
  target = dds_string_alloc(text.size());
  std::copy(text.begin(), text.end(), target);
  target[text.size()] = '\0';
}

/// Puts an empty name for the unknown verdict.
inline void PutVerdict(char*& target, PromotionVerdict verdict) {
  Put(target, verdict == PromotionVerdict::kUnknown ? std::string_view() : Name(verdict));
}

/// Copies a vehicle or correlation id. Requires IsVehicleId(text).
void PutIdentifier(auto& target, std::string_view text) {
  Require(IsVehicleId(text), "a vehicle or correlation id of letters, digits, '.', '_' and '-'");
  Put(target, text);
}

/// Gives a wire sequence `items.size()` elements and fills each with `fill(element, item)`.
template <class Sequence, class Items, class Fill>
void PutSequence(Sequence& sequence, const Items& items, Fill fill) {
  if (items.size() == 0) return;
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  sequence._buffer = static_cast<Element*>(dds_alloc(items.size() * sizeof(Element)));
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
  sequence._release = true;
  Element* element = sequence._buffer;
  for (const auto& item : items) fill(*element++, item);
}

/// Fills a sequence of none or one, which is how the IDL states an optional value.
template <class Sequence, class Item, class Fill>
void PutOptional(Sequence& sequence, const std::optional<Item>& item, Fill fill) {
  if (item) PutSequence(sequence, std::span<const Item, 1>(&*item, 1), fill);
}

void PutNumbers(dds_sequence_double& sequence, const auto& values) {
  PutSequence(sequence, values, [](double& element, double value) { element = value; });
}

}  // namespace telltale::wire
