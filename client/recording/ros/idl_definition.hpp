#pragma once

#include <string>
#include <string_view>

namespace telltale {

/// Types that IDL defines, as MCAP's ros2idl has them, in the .msg format that RosMessageType
/// takes: structures, sequences, arrays of one dimension and typedefs of these. Constants,
/// annotations and comments are passed over, and so is what has no .msg: unions, enumerations,
/// wide strings.
/// Source: OMG IDL 4.2, the part that rosidl writes; MCAP registry, "ros2idl".
std::string RosDefinitionOfIdl(std::string_view idl);

}  // namespace telltale
