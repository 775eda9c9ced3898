#include "telltale/client/recording/field_path.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace telltale {
namespace {

// Takes "[2]" off the front of `text`.
std::optional<std::size_t> TakeIndex(std::string_view& text) {
  std::size_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
  if (error != std::errc() || stop == end || *stop != ']') return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()) + 1);
  return index;
}

}  // namespace

std::optional<std::vector<PathStep>> StepsOf(std::string_view path) {
  std::vector<PathStep> steps;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('.'), path.size());
    std::string_view part = path.substr(0, end);
    path.remove_prefix(std::min(end + 1, path.size()));
    PathStep step;
    step.name = part.substr(0, part.find('['));
    part.remove_prefix(step.name.size());
    while (!part.empty()) {
      if (step.index) steps.push_back(std::exchange(step, {}));
      if (!part.starts_with('[')) return std::nullopt;
      step.index = TakeIndex(part);
      if (!step.index) return std::nullopt;
    }
    steps.push_back(step);
  }
  return steps.empty() ? std::nullopt : std::optional(std::move(steps));
}

}  // namespace telltale
