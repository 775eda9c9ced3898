#include "telltale/idl/codec/json/json_message.hpp"

#include <algorithm>
#include <cctype>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;

std::string ValueNames(const EnumDescriptor& type) {
  std::string names;
  for (int i = 0; i < type.value_count(); ++i) {
    if (type.value(i)->number() == 0) continue;  // zero means "not done"
    names += (names.empty() ? "one of " : ", ") + type.value(i)->name();
  }
  return names;
}

// Protobuf calls types "TYPE_UINT32" or "type.googleapis.com/package.Enum".
std::string AllowedFor(std::string_view type) {
  const std::string name(type.substr(type.rfind('/') + 1));
  const EnumDescriptor* values = DescriptorPool::generated_pool()->FindEnumTypeByName(name);
  if (values) return ValueNames(*values);
  if (name == "TYPE_DOUBLE") return "a number";
  if (name == "TYPE_UINT32") return "a whole number in [0, 4294967295]";
  if (name == "TYPE_UINT64") return "a whole number in [0, 18446744073709551615]";
  return "a value of type " + name;
}

// Protobuf names the fields as the .proto does: "one_step.r2" is "oneStep.r2" in JSON.
std::string JsonPath(std::string_view path) {
  std::string json;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool capital = path[i] == '_' && i + 1 < path.size();
    json += capital ? static_cast<char>(std::toupper(path[++i])) : path[i];
  }
  return json;
}

// Takes the "(path)" off the front of a message, if there is one.
std::string TakePath(std::string_view& message) {
  const auto end = message.find(')');
  if (!message.starts_with('(') || end == std::string_view::npos) return "";
  std::string path = JsonPath(message.substr(1, end - 1));
  message.remove_prefix(end + 1);
  return path;
}

// Protobuf tells faults of JSON only in words: "(path): invalid value V for type T",
// "(path) name: Cannot find field.", or what is wrong with the syntax, then an excerpt.
CodecError ErrorOf(std::string_view message, const std::string& file) {
  constexpr std::string_view kWrongValue = ": invalid value ";
  constexpr std::string_view kForType = " for type ";
  constexpr std::string_view kUnknownField = ": Cannot find field.";
  const std::string_view whole = message;
  const std::string path = TakePath(message);
  const auto type = message.rfind(kForType);
  if (message.starts_with(kWrongValue) && type != std::string_view::npos) {
    const auto value = message.substr(kWrongValue.size(), type - kWrongValue.size());
    return {path, std::string(value), AllowedFor(message.substr(type + kForType.size())), file};
  }
  if (message.ends_with(kUnknownField)) {
    message.remove_suffix(kUnknownField.size());
    message.remove_prefix(std::min(message.find_first_not_of(' '), message.size()));
    return {(path.empty() ? "" : path + ".") + JsonPath(message), "(given)", "no such field", file};
  }
  const std::string first_line(whole.substr(0, whole.find('\n')));
  return {"(text)", "(not JSON of this kind)", first_line, file};
}

std::string PrintJson(const google::protobuf::Message& message, bool indented) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = indented;
  options.always_print_primitive_fields = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  Require(status.ok(), "a message whose strings are UTF-8");
  return text;
}

}  // namespace

std::string PrintJsonMessage(const google::protobuf::Message& message) {
  return PrintJson(message, true);
}

std::string PrintJsonLine(const google::protobuf::Message& message) {
  return PrintJson(message, false);
}

std::optional<CodecError> ParseJsonMessage(std::string_view text, const std::string& file,
                                           google::protobuf::Message& message) {
  const auto status =
      google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message);
  if (status.ok()) return std::nullopt;
  return ErrorOf({status.message().data(), status.message().size()}, file);
}

}  // namespace telltale
