#include "telltale/idl/codec/json/model_version.hpp"

#include <array>
#include <charconv>

#include <google/protobuf/struct.pb.h>

#include "telltale/idl/codec/field_reader.hpp"
#include "telltale/idl/codec/json/json_message.hpp"

namespace telltale {
namespace {

using VersionNumbers = std::array<int, 3>;

/// Major, minor and patch of "1.2.3"; nothing for any other text.
std::optional<VersionNumbers> NumbersOf(std::string_view version) {
  VersionNumbers numbers{};
  const char* at = version.data();
  const char* const end = at + version.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    const bool last = i + 1 == numbers.size();
    if (error != std::errc() || (last ? next != end : next == end || *next != '.')) {
      return std::nullopt;
    }
    at = last ? next : next + 1;
  }
  return numbers;
}

/// The version that a JSON text names in provenance.softwareVersion, whatever else it holds.
std::string WriterVersion(std::string_view text, const std::string& file) {
  google::protobuf::Struct model;
  if (ParseJsonMessage(text, file, model)) return "";
  const auto provenance = model.fields().find("provenance");
  if (provenance == model.fields().end()) return "";
  const auto& entries = provenance->second.struct_value().fields();
  const auto version = entries.find("softwareVersion");
  return version == entries.end() ? "" : version->second.string_value();
}

}  // namespace

std::optional<CodecError> OutdatedModel(std::string_view text, const std::string& file) {
  const std::string version = WriterVersion(text, file);
  const auto numbers = NumbersOf(version);
  if (!numbers || *numbers >= *NumbersOf(kOldestModelVersion)) return std::nullopt;
  return CodecError{"provenance.softwareVersion", Quoted(version),
                    "this version reads models of version " + std::string(kOldestModelVersion) +
                        " and later; identify the vehicle again with this version",
                    file};
}

}  // namespace telltale
