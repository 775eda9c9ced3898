#include "telltale/idl/codec/field_reader.hpp"

#include <cstdio>
#include <utility>

#include <google/protobuf/descriptor.h>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr int kSingular = -1;  // Protobuf's index of a field that is not repeated

}  // namespace

bool FieldRange::Contains(double value) const {
  return (low_excluded ? value > low : value >= low) && value <= high;
}

std::string FieldRange::Text() const {
  return std::string("a number in ") + (low_excluded ? "(" : "[") + NumberText(low) + ", " +
         NumberText(high) + "]";
}

std::string NumberText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

std::string Quoted(std::string_view text) {
  return '"' + std::string(text) + '"';
}

FieldReader::FieldReader(const Message& message, const FieldSource& source,
                         std::optional<CodecError>& fault)
    : message_(&message), source_(&source), fault_(&fault), lines_(source.lines) {}

double FieldReader::Number(std::string_view field, FieldRange range) {
  const FieldDescriptor& descriptor = Field(field);
  if (!Given(descriptor)) Fail(field, "", "required, " + range.Text());
  return Checked(field, range, message_->GetReflection()->GetDouble(*message_, &descriptor));
}

double FieldReader::Number(std::string_view field, FieldRange range, double fallback) {
  return Has(field) ? Number(field, range) : fallback;
}

std::uint32_t FieldReader::Count(std::string_view field, FieldRange range, std::uint32_t fallback) {
  if (!Has(field)) return fallback;
  const std::uint32_t value = message_->GetReflection()->GetUInt32(*message_, &Field(field));
  Checked(field, range, value);
  return value;
}

std::string FieldReader::Text(std::string_view field) {
  const FieldDescriptor& descriptor = Field(field);
  if (!Given(descriptor)) Fail(field, "", "required");
  return message_->GetReflection()->GetString(*message_, &descriptor);
}

std::string FieldReader::Text(std::string_view field, std::string_view fallback) {
  return Has(field) ? Text(field) : std::string(fallback);
}

bool FieldReader::Has(std::string_view field) const {
  return message_->GetReflection()->HasField(*message_, &Field(field));
}

FieldReader FieldReader::Required(std::string_view field) {
  if (!Has(field)) Fail(field, "", "required");
  return Optional(field);
}

FieldReader FieldReader::Optional(std::string_view field) {
  return Item(field, kSingular);
}

std::vector<FieldReader> FieldReader::Repeated(std::string_view field) {
  const int size = message_->GetReflection()->FieldSize(*message_, &Field(field));
  std::vector<FieldReader> items;
  for (int i = 0; i < size; ++i) items.push_back(Item(field, i));
  return items;
}

FieldReader FieldReader::Item(std::string_view field, int index) {
  const FieldDescriptor& descriptor = Field(field);
  const auto& reflection = *message_->GetReflection();
  const bool given = index != kSingular || reflection.HasField(*message_, &descriptor);
  FieldReader item = *this;
  item.message_ = index == kSingular
                      ? &reflection.GetMessage(*message_, &descriptor)
                      : &reflection.GetRepeatedMessage(*message_, &descriptor, index);
  item.path_ = PathOf(descriptor, index);
  item.line_ = LineOf(descriptor, index);
  item.lines_ = lines_ && given ? lines_->GetTreeForNested(&descriptor, index) : nullptr;
  return item;
}

void FieldReader::Fail(std::string_view field, std::string value, std::string allowed) {
  FailItem(field, kSingular, std::move(value), std::move(allowed));
}

void FieldReader::FailItem(std::string_view field, int index, std::string value,
                           std::string allowed) {
  if (*fault_) return;
  const FieldDescriptor& descriptor = Field(field);
  const int line = LineOf(descriptor, index);
  const std::string place = line > 0 ? source_->file + ":" + std::to_string(line) : source_->file;
  *fault_ = CodecError{PathOf(descriptor, index), std::move(value), std::move(allowed), place};
}

const FieldDescriptor& FieldReader::Field(std::string_view name) const {
  const FieldDescriptor* field = message_->GetDescriptor()->FindFieldByName(std::string(name));
  if (field == nullptr) throw ContractViolation("FieldReader: requires a field of this message");
  return *field;
}

bool FieldReader::Given(const FieldDescriptor& field) const {
  return !field.has_presence() || message_->GetReflection()->HasField(*message_, &field);
}

double FieldReader::Checked(std::string_view field, FieldRange range, double value) {
  if (!range.Contains(value)) Fail(field, NumberText(value), range.Text());
  return value;
}

std::string FieldReader::PathOf(const FieldDescriptor& field, int index) const {
  const bool json = source_->names == FieldSource::Names::kJson;
  std::string path = path_.empty() ? "" : path_ + ".";
  path += json ? field.json_name() : field.name();
  if (index != kSingular) path.append("[").append(std::to_string(index)).append("]");
  return path;
}

int FieldReader::LineOf(const FieldDescriptor& field, int index) const {
  if (!lines_) return line_;
  const bool missing_item = field.is_repeated() && index == kSingular;
  const int line = missing_item ? -1 : lines_->GetLocation(&field, index).line;
  return line < 0 ? line_ : line + 1;
}

}  // namespace telltale
