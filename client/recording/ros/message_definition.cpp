#include "telltale/client/recording/ros/message_definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "telltale/client/recording/field_path.hpp"
#include "telltale/client/recording/trimmed.hpp"

namespace telltale {
namespace {

constexpr int kDeepest = 16;           // types below types
constexpr std::uint64_t kSteps = 1e6;  // values read on the way to one number
constexpr std::string_view kBlanks = " \t\r";

/// Definitions that databases of ROS 2 leave out and that a mapping is most likely to name.
constexpr std::string_view kCommonTypes = R"(
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: std_msgs/Float64
float64 data
===
MSG: std_msgs/Float32
float32 data
===
MSG: std_msgs/Int16
int16 data
===
MSG: std_msgs/Int32
int32 data
===
MSG: std_msgs/UInt16
uint16 data
===
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
===
MSG: std_msgs/MultiArrayLayout
MultiArrayDimension[] dim
uint32 data_offset
===
MSG: std_msgs/Float32MultiArray
MultiArrayLayout layout
float32[] data
===
MSG: std_msgs/Float64MultiArray
MultiArrayLayout layout
float64[] data
===
MSG: sensor_msgs/NavSatStatus
int8 status
uint16 service
===
MSG: sensor_msgs/NavSatFix
std_msgs/Header header
NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
===
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
===
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
===
MSG: geometry_msgs/Pose
Point position
Quaternion orientation
===
MSG: geometry_msgs/PoseWithCovariance
Pose pose
float64[36] covariance
===
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
Pose pose
===
MSG: geometry_msgs/Twist
Vector3 linear
Vector3 angular
===
MSG: geometry_msgs/TwistStamped
std_msgs/Header header
Twist twist
===
MSG: geometry_msgs/QuaternionStamped
std_msgs/Header header
Quaternion quaternion
===
MSG: geometry_msgs/Vector3Stamped
std_msgs/Header header
Vector3 vector
===
MSG: sensor_msgs/Imu
std_msgs/Header header
geometry_msgs/Quaternion orientation
===
MSG: nav_msgs/Odometry
std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
===
MSG: geographic_msgs/GeoPoint
float64 latitude
float64 longitude
float64 altitude
===
MSG: geographic_msgs/GeoPose
GeoPoint position
geometry_msgs/Quaternion orientation
===
MSG: geographic_msgs/GeoPoseStamped
std_msgs/Header header
GeoPose pose
===
MSG: mavros_msgs/RCOut
std_msgs/Header header
uint16[] channels
===
MSG: heron_msgs/Drive
float32 left
float32 right
)";

std::string_view FirstWord(std::string_view& text) {
  text = Trimmed(text);
  const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text = Trimmed(text.substr(end));
  return word;
}

/// package/msg/Type as package/Type.
std::string ShortName(std::string_view name) {
  const std::size_t msg = name.find("/msg/");
  if (msg == std::string_view::npos) return std::string(name);
  return std::string(name.substr(0, msg)) + std::string(name.substr(msg + 4));
}

bool IsBuiltIn(std::string_view type) {
  constexpr std::array kBuiltIn = {"bool",    "byte",   "char",   "int8",    "uint8",  "int16",
                                   "uint16",  "int32",  "uint32", "int64",   "uint64", "float32",
                                   "float64", "string", "time",   "duration"};
  return std::find(kBuiltIn.begin(), kBuiltIn.end(), type) != kBuiltIn.end();
}

/// `TYPE NAME`, or nothing of a constant, a comment or a line that is neither.
std::optional<RosMessageType::Field> FieldOf(std::string_view line, std::string_view package) {
  line = line.substr(0, line.find('#'));
  std::string_view type = FirstWord(line);
  const std::string_view name = FirstWord(line);
  const bool is_constant = name.find('=') != std::string_view::npos || line.starts_with('=');
  if (type.empty() || name.empty() || is_constant) return std::nullopt;

  RosMessageType::Field field;
  field.name = std::string(name);
  const std::size_t bracket = type.find('[');
  if (bracket != std::string_view::npos) {
    const std::string_view length = type.substr(bracket + 1, type.find(']') - bracket - 1);
    type = type.substr(0, bracket);
    const auto [end, error] =
        std::from_chars(length.data(), length.data() + length.size(), field.length);
    const bool is_fixed = error == std::errc() && end == length.data() + length.size();
    field.count =
        is_fixed ? RosMessageType::Field::Count::kFixed : RosMessageType::Field::Count::kSequence;
  }
  type = type.substr(0, type.find("<="));  // a string of bounded length
  if (IsBuiltIn(type)) {
    field.type = std::string(type);
  } else if (type.find('/') != std::string_view::npos) {
    field.type = ShortName(type);
  } else if (type == "Header") {
    field.type = "std_msgs/Header";
  } else {
    field.type = std::string(package) + '/' + std::string(type);
  }
  return field;
}

using RosTypes = std::map<std::string, RosMessageType::Fields, std::less<>>;

void AddTypes(const std::string& first, std::string_view text, RosTypes& types) {
  std::string type = first;
  bool is_new = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = Trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("===")) {
      type.clear();
      continue;
    }
    if (line.starts_with("MSG:")) {
      type = ShortName(Trimmed(line.substr(4)));
      is_new = true;
      continue;
    }
    if (type.empty()) continue;
    if (is_new) types[type].clear();
    is_new = false;
    if (auto field = FieldOf(line, std::string_view(type).substr(0, type.find('/')))) {
      types[type].push_back(*std::move(field));
    }
  }
}

/// Walks a message from its begin to one number.
class RosWalk {
 public:
  RosWalk(const RosMessageType& type, std::span<const std::uint8_t> bytes,
          CdrReader::Encoding encoding)
      : types_(type), cdr_(bytes, encoding) {}

  std::optional<double> To(std::span<const PathStep> path, std::string_view type, int depth = 0) {
    const RosMessageType::Fields* fields = types_.FieldsOf(type);
    if (fields == nullptr || path.empty() || depth > kDeepest) return std::nullopt;
    for (const RosMessageType::Field& field : *fields) {
      const bool is_wanted = field.name == path.front().name;
      const std::uint64_t count = CountOf(field);
      const bool is_array = field.count != RosMessageType::Field::Count::kOne;
      if (is_wanted && is_array != path.front().index.has_value()) return std::nullopt;
      const std::uint64_t index = path.front().index.value_or(0);
      if (is_wanted && index >= count) return std::nullopt;
      for (std::uint64_t i = 0; i < (is_wanted ? index : count) && Goes(); ++i) {
        Skip(field.type, depth + 1);
      }
      if (!Goes()) return std::nullopt;
      if (!is_wanted) continue;
      if (path.size() == 1) return BuiltIn(field.type);
      return To(path.subspan(1), field.type, depth + 1);
    }
    return std::nullopt;
  }

 private:
  bool Goes() const { return cdr_.Ok() && steps_ < kSteps; }

  std::uint64_t CountOf(const RosMessageType::Field& field) {
    return field.count == RosMessageType::Field::Count::kSequence ? cdr_.Read<std::uint32_t>()
                                                                  : field.length;
  }

  void Skip(std::string_view type, int depth) {
    ++steps_;
    const RosMessageType::Fields* fields = types_.FieldsOf(type);
    if (fields == nullptr || depth > kDeepest) {
      if (type == "string") {
        cdr_.ReadString();
      } else if (!BuiltIn(type)) {
        steps_ = kSteps;  // an unknown type is as long as nobody knows
      }
      return;
    }
    for (const RosMessageType::Field& field : *fields) {
      const std::uint64_t count = CountOf(field);
      for (std::uint64_t i = 0; i < count && Goes(); ++i) Skip(field.type, depth + 1);
    }
  }

  template <class Value>
  std::optional<double> Take() {
    const Value value = cdr_.Read<Value>();
    if (!cdr_.Ok()) return std::nullopt;
    return static_cast<double>(value);
  }

  std::optional<double> BuiltIn(std::string_view type) {
    if (type == "bool" || type == "byte" || type == "char" || type == "uint8") {
      return Take<std::uint8_t>();
    }
    if (type == "int8") return Take<std::int8_t>();
    if (type == "int16") return Take<std::int16_t>();
    if (type == "uint16") return Take<std::uint16_t>();
    if (type == "int32") return Take<std::int32_t>();
    if (type == "uint32") return Take<std::uint32_t>();
    if (type == "int64") return Take<std::int64_t>();
    if (type == "uint64") return Take<std::uint64_t>();
    if (type == "float32") return Take<float>();
    if (type == "float64") return Take<double>();
    return std::nullopt;
  }

  const RosMessageType& types_;
  CdrReader cdr_;
  std::uint64_t steps_ = 0;
};

}  // namespace

std::optional<RosMessageType> RosMessageType::Of(std::string_view name, std::string_view definition,
                                                 CdrReader::Encoding encoding) {
  static const RosTypes common = [] {
    RosTypes types;
    AddTypes("", kCommonTypes, types);
    types["time"] = {{"sec", "uint32"}, {"nsec", "uint32"}};  // of ROS 1
    types["duration"] = {{"sec", "int32"}, {"nsec", "int32"}};
    return types;
  }();
  RosMessageType type;
  type.name_ = ShortName(name);
  type.types_ = common;
  if (encoding == CdrReader::Encoding::kRos1) {
    type.types_["std_msgs/Header"] = {{"seq", "uint32"}, {"stamp", "time"}, {"frame_id", "string"}};
  }
  AddTypes(type.name_, definition, type.types_);
  if (!type.types_.contains(type.name_)) return std::nullopt;
  return type;
}

const RosMessageType::Fields* RosMessageType::FieldsOf(std::string_view type) const {
  const auto found = types_.find(type);
  return found == types_.end() ? nullptr : &found->second;
}

const RosMessageType* RosMessageTypes::Find(std::string_view name, std::string_view definition,
                                            CdrReader::Encoding encoding) {
  auto known = types_.find(name);
  if (known == types_.end()) {
    known = types_.emplace(std::string(name), RosMessageType::Of(name, definition, encoding)).first;
  }
  return known->second ? &*known->second : nullptr;
}

std::vector<std::string> RosMessageTypes::Unknown() const {
  std::vector<std::string> names;
  for (const auto& [name, type] : types_) {
    if (!type) names.push_back(name);
  }
  return names;
}

std::optional<double> RosFields::Number(std::string_view path) const {
  const auto steps = StepsOf(path);
  if (!steps) return std::nullopt;
  return RosWalk(type_, bytes_, encoding_).To(*steps, type_.Name());
}

}  // namespace telltale
