#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace telltale {

/// One step into a message: to a field, and where an index is given to an element of it. A second
/// index makes a step without a name.
struct PathStep {
  std::string_view name;
  std::optional<std::size_t> index;
};

/// The steps of a path such as "pose.pose.orientation.x" or "channels[2]"; nothing where the path
/// is empty or an index is none.
std::optional<std::vector<PathStep>> StepsOf(std::string_view path);

}  // namespace telltale
