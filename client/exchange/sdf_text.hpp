#pragma once

#include <string>
#include <string_view>

namespace telltale {

/// A number with six significant digits.
std::string Text(double value);

/// An XML comment on a line of its own. XML forbids two hyphens in a row within one, and vehicle
/// ids may have them: a space parts them.
std::string Comment(std::string_view text);

/// "  <name>value</name>  <!-- remark -->" and the end of the line.
std::string Element(std::string_view name, double value, std::string_view remark);

}  // namespace telltale
