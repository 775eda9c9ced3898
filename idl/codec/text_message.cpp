#include "telltale/idl/codec/text_message.hpp"

#include <algorithm>
#include <cctype>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

namespace telltale {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::TextFormat;

constexpr int kTabStop = 8;  // Protobuf's tokenizer counts columns so

bool IsNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::string_view LineAt(std::string_view text, int line) {
  for (; line > 0; --line) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

std::size_t OffsetOf(std::string_view line, int column) {
  std::size_t offset = 0;
  for (int at = 0; offset < line.size() && at < column; ++offset) {
    at += line[offset] == '\t' ? kTabStop - at % kTabStop : 1;
  }
  return offset;
}

// The name that stands before an offset, as in "name: |value" or "name| : value".
std::string NameBefore(std::string_view line, std::size_t offset) {
  auto end = offset;
  while (end > 0 && !IsNameCharacter(line[end - 1])) --end;
  auto begin = end;
  while (begin > 0 && IsNameCharacter(line[begin - 1])) --begin;
  return std::string(line.substr(begin, end - begin));
}

std::string ValueFrom(std::string_view line, std::size_t offset) {
  const auto begin = line.find_first_not_of(": \t", offset);
  if (begin == std::string_view::npos) return "";
  const auto end = line.find_first_of(" \t\r#;,}", begin + 1);
  return std::string(line.substr(begin, end - begin));
}

// What stands between the first pair of quotes after `lead`.
std::string QuotedAfter(const std::string& message, const std::string& lead) {
  const auto begin = message.find(lead + "\"");
  if (begin == std::string::npos) return "";
  const auto first = begin + lead.size() + 1;
  return message.substr(first, message.find('"', first) - first);
}

std::string FieldNames(const google::protobuf::Descriptor& type) {
  std::string names;
  for (int i = 0; i < type.field_count(); ++i) {
    names += (i == 0 ? "" : ", ") + type.field(i)->name();
  }
  return names;
}

// Protobuf names the message type of an unknown field: say which fields that type has instead.
std::string Allowed(const std::string& message, const std::string& unknown_field) {
  if (unknown_field.empty()) return message;
  const std::string type_name = QuotedAfter(message, "Message type ");
  const google::protobuf::Descriptor* type =
      DescriptorPool::generated_pool()->FindMessageTypeByName(type_name);
  return type ? "no such field; there are " + FieldNames(*type) : "no such field";
}

class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  FirstError(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  void AddError(int line, int column, const std::string& message) override {
    if (error_) return;
    const std::string_view source = LineAt(text_, line);
    const std::size_t offset = OffsetOf(source, column);
    const std::string unknown_field = QuotedAfter(message, "has no field named ");
    const std::string name = unknown_field.empty() ? NameBefore(source, offset) : unknown_field;
    error_ = CodecError{name.empty() ? "(text)" : name, ValueFrom(source, offset),
                        Allowed(message, unknown_field), file_ + ":" + std::to_string(line + 1)};
  }

  void AddWarning(int, int, const std::string&) override {}

  const std::optional<CodecError>& Error() const { return error_; }

 private:
  std::string_view text_;
  std::string file_;
  std::optional<CodecError> error_;
};

}  // namespace

std::optional<CodecError> ParseTextMessage(std::string_view text, const std::string& file,
                                           google::protobuf::Message& message,
                                           TextFormat::ParseInfoTree& lines) {
  FirstError first_error(text, file);
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&first_error);
  parser.WriteLocationsTo(&lines);
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  if (parser.Parse(&stream, &message)) return std::nullopt;
  if (first_error.Error()) return first_error.Error();
  return CodecError{"(text)", "", "Protobuf text format", file};
}

}  // namespace telltale
