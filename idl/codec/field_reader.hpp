#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include "telltale/idl/codec/codec_error.hpp"

namespace telltale {

/// Allowed values of a field, both ends included unless said otherwise.
struct FieldRange {
  double low = 0.0;
  double high = 0.0;
  bool low_excluded = false;

  bool Contains(double value) const;  ///< never true for NaN
  std::string Text() const;           ///< "a number in [low, high]"
};

/// Those that many fields share: what is not called finite may be infinite, but never NaN.
inline constexpr double kLargest = std::numeric_limits<double>::max();
inline constexpr FieldRange kNotNan{-std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<double>::infinity()};
inline constexpr FieldRange kNotNegative{0.0, kNotNan.high};
inline constexpr FieldRange kFinite{-kLargest, kLargest};
inline constexpr FieldRange kFiniteNotNegative{0.0, kLargest};
inline constexpr FieldRange kFinitePositive{0.0, kLargest, true};
inline constexpr FieldRange kShare{0.0, 1.0};

/// A number as messages show it, up to 15 significant digits.
std::string NumberText(double value);
std::string Quoted(std::string_view text);

/// Where a message was read from: what an error is to name.
struct FieldSource {
  enum class Names { kProto, kJson };

  std::string file;
  Names names = Names::kProto;  ///< how the source spells field names
  const google::protobuf::TextFormat::ParseInfoTree* lines = nullptr;  ///< null: lines unknown
};

/// One Protobuf message seen field by field, by the names in its .proto file. The first fault met
/// is kept in `fault` and later ones are passed over, so that reading code states ranges alone and
/// asks for the fault once, at the end. What is returned after a fault is only there to be
/// discarded. Assumes: message, fault and source outlive the reader; naming a field that does not
/// exist, or as another type than it has, breaks the contract.
class FieldReader {
 public:
  FieldReader(const google::protobuf::Message& message, const FieldSource& source,
              std::optional<CodecError>& fault);

  /// A field that has to be there, unless it has no presence and then reads as its zero.
  double Number(std::string_view field, FieldRange range);
  std::string Text(std::string_view field);

  /// A field that takes `fallback` when unset.
  double Number(std::string_view field, FieldRange range, double fallback);
  std::uint32_t Count(std::string_view field, FieldRange range, std::uint32_t fallback);
  std::string Text(std::string_view field, std::string_view fallback);

  bool Has(std::string_view field) const;

  FieldReader Required(std::string_view field);
  FieldReader Optional(std::string_view field);
  std::vector<FieldReader> Repeated(std::string_view field);
  FieldReader Item(std::string_view field, int index);

  void Fail(std::string_view field, std::string value, std::string allowed);
  void FailItem(std::string_view field, int index, std::string value, std::string allowed);

 private:
  const google::protobuf::FieldDescriptor& Field(std::string_view name) const;
  bool Given(const google::protobuf::FieldDescriptor& field) const;
  double Checked(std::string_view field, FieldRange range, double value);
  std::string PathOf(const google::protobuf::FieldDescriptor& field, int index) const;
  int LineOf(const google::protobuf::FieldDescriptor& field, int index) const;

  const google::protobuf::Message* message_;
  const FieldSource* source_;
  std::optional<CodecError>* fault_;
  const google::protobuf::TextFormat::ParseInfoTree* lines_;
  std::string path_;
  int line_ = 0;  ///< where the message begins, from 1; 0 unknown
};

}  // namespace telltale
