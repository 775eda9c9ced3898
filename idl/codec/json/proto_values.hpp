#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/generated_enum_reflection.h>

#include "telltale/idl/codec/field_reader.hpp"

namespace telltale {

/// Between an enumeration of core and its Protobuf likeness, either way. Assumes that both have the
/// same order with the unknown value first; tests hold them to it.
template <class To, class From>
To EnumCast(From value) {
  return static_cast<To>(static_cast<int>(value));
}

/// A count in the 32 bits of a message, at most the largest that they hold.
inline std::uint32_t Saturated(std::uint64_t count) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(count, kMost));
}

/// The enumerator of core that `value` stands for. Fails on zero, which means unset, and on numbers
/// that no enumerator has. Assumes enumerators without gaps.
template <class Core, class Proto>
Core ReadEnum(FieldReader& reader, const char* field, Proto value) {
  const auto& type = *google::protobuf::GetEnumDescriptor<Proto>();
  const int number = static_cast<int>(value);
  if (number >= 1 && number < type.value_count()) return EnumCast<Core>(value);
  std::string allowed;
  for (int i = 1; i < type.value_count(); ++i) {
    allowed += (allowed.empty() ? "one of " : ", ") + type.value(i)->name();
  }
  reader.Fail(field, number == 0 ? "" : std::to_string(number), allowed);
  return Core{};
}

/// Every item of a repeated message field through `read(its reader, item)`.
template <class Messages, class Read>
auto ReadAll(FieldReader& reader, const char* field, const Messages& messages, Read read) {
  std::vector<decltype(read(reader, messages[0]))> items;
  for (int i = 0; i < messages.size(); ++i) {
    items.push_back(read(reader.Item(field, i), messages[i]));
  }
  return items;
}

}  // namespace telltale
