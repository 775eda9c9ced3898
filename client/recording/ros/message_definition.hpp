#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "telltale/client/recording/message_fields.hpp"
#include "telltale/client/recording/ros/cdr_reader.hpp"

namespace telltale {

/// The fields of one ROS message type and of the types below it.
/// Source: the .msg format of ROS 1 and ROS 2, types concatenated as bags and MCAP's ros2msg have
/// them: after a line of "=" each, "MSG: package/Type".
class RosMessageType {
 public:
  struct Field {
    enum class Count { kOne, kFixed, kSequence };
    std::string name;
    std::string type;  ///< a built-in one, or package/Type
    Count count = Count::kOne;
    std::size_t length = 1;  ///< of kFixed
  };
  using Fields = std::vector<Field>;

  /// `name` as package/Type or package/msg/Type. Types that `definition` leaves out are those of
  /// common packages, where they are known; none where the message itself stays unknown.
  static std::optional<RosMessageType> Of(std::string_view name, std::string_view definition,
                                          CdrReader::Encoding encoding = CdrReader::Encoding::kCdr);

  const std::string& Name() const { return name_; }

  /// Null: not a type with fields.
  const Fields* FieldsOf(std::string_view type) const;

 private:
  std::string name_;
  std::map<std::string, Fields, std::less<>> types_;
};

/// Message types by name, each opened once.
class RosMessageTypes {
 public:
  /// Null: the type is not known. Of a name that was asked for before, `definition` is passed over.
  const RosMessageType* Find(std::string_view name, std::string_view definition,
                             CdrReader::Encoding encoding);

  /// The names that are not known.
  std::vector<std::string> Unknown() const;

 private:
  std::map<std::string, std::optional<RosMessageType>, std::less<>> types_;
};

/// One serialised message. Assumes: type and bytes outlive it.
class RosFields : public MessageFields {
 public:
  RosFields(const RosMessageType& type, std::span<const std::uint8_t> bytes,
            CdrReader::Encoding encoding)
      : type_(type), bytes_(bytes), encoding_(encoding) {}

  std::optional<double> Number(std::string_view path) const override;

 private:
  const RosMessageType& type_;
  std::span<const std::uint8_t> bytes_;
  CdrReader::Encoding encoding_;
};

}  // namespace telltale
