#include "telltale/client/cli/help_formatter.hpp"

#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

constexpr std::size_t kNameColumns = 28;

}  // namespace

HelpFormatter::HelpFormatter() {
  column_width(kNameColumns);
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string description = CLI::Formatter::make_option_desc(option);
  std::string wrapped = Wrapped(description, "", kTerminalColumns - kNameColumns);
  if (!wrapped.empty()) wrapped.pop_back();
  return wrapped;
}

}  // namespace telltale
