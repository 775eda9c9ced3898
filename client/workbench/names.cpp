#include "telltale/client/workbench/names.hpp"

#include <algorithm>

#include "telltale/client/workbench/errors.hpp"

namespace telltale {

void RequireOneOf(const OptionNames& names, const std::string& option, const std::string& value) {
  if (std::find(names.begin(), names.end(), value) != names.end()) return;
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw UsageError(option + ": " + value + " is none of " + known);
}

}  // namespace telltale
