#include "telltale/client/bridge/ros2_names.hpp"

#include <algorithm>
#include <cctype>

namespace telltale {
namespace {

constexpr std::string_view kPlaceholder = kVehiclePlaceholder;

bool MayBeInName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Whether a topic is below a namespace without a placeholder.
bool IsBelow(std::string_view name_space, std::string_view topic) {
  if (name_space == "/") return true;
  return topic.starts_with(name_space) && topic.substr(name_space.size()).starts_with('/');
}

}  // namespace

std::optional<std::string> RosTopicOfDds(std::string_view topic) {
  constexpr std::string_view kPrefix = "rt/";
  if (!topic.starts_with(kPrefix)) return std::nullopt;
  return std::string(topic.substr(kPrefix.size() - 1));
}

std::optional<std::string> RosTypeOfDds(std::string_view type) {
  constexpr std::string_view kBetween = "::msg::dds_::";
  const std::size_t at = type.find(kBetween);
  if (at == std::string_view::npos || !type.ends_with('_')) return std::nullopt;
  const std::string_view name = type.substr(at + kBetween.size());
  return std::string(type.substr(0, at)) + "/msg/" + std::string(name.substr(0, name.size() - 1));
}

std::optional<std::string> VehicleInTopic(std::string_view pattern, std::string_view topic) {
  const std::size_t at = pattern.find(kPlaceholder);
  if (at == std::string_view::npos) {
    return IsBelow(pattern, topic) ? std::optional<std::string>("") : std::nullopt;
  }
  if (!topic.starts_with(pattern.substr(0, at))) return std::nullopt;
  topic.remove_prefix(at);
  const std::string_view rest = pattern.substr(at + kPlaceholder.size());
  const std::string_view tail = rest.substr(0, rest.find('/'));  // of the same token
  const std::string_view token = topic.substr(0, topic.find('/'));
  if (token.size() <= tail.size() || !token.ends_with(tail)) return std::nullopt;
  const std::string_view vehicle = token.substr(0, token.size() - tail.size());
  const std::string_view below = topic.substr(vehicle.size());
  if (!below.starts_with(rest) || !below.substr(rest.size()).starts_with('/')) return std::nullopt;
  return std::string(vehicle);
}

std::string VehicleIdOf(const std::string& pattern, const std::string& vehicle) {
  std::string vehicle_id = pattern;
  const std::size_t at = vehicle_id.find(kPlaceholder);
  if (at != std::string::npos) vehicle_id.replace(at, kPlaceholder.size(), vehicle);
  return vehicle_id;
}

std::string RosNameOf(std::string_view vehicle_id) {
  std::string name(vehicle_id);
  std::ranges::replace_if(
      name, [](char c) { return !MayBeInName(c); }, '_');
  const bool begins_with_digit = std::isdigit(static_cast<unsigned char>(name.front())) != 0;
  return begins_with_digit ? "vehicle_" + name : name;
}

std::optional<std::string> NamespaceFault(const std::string& pattern) {
  if (pattern == "/") return std::nullopt;
  std::string without = pattern;
  const std::size_t at = without.find(kPlaceholder);
  if (at != std::string::npos) without.replace(at, kPlaceholder.size(), "x");
  const bool sound =
      without.starts_with('/') && !without.ends_with('/') &&
      without.find("//") == std::string::npos &&
      std::ranges::all_of(without, [](char c) { return MayBeInName(c) || c == '/'; });
  if (sound) return std::nullopt;
  return pattern +
         " must be / or names of letters, digits and '_', each after a '/', in which {vehicle} may "
         "stand once";
}

}  // namespace telltale
