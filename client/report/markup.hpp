#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace telltale {

/// A piece of HTML or SVG. Plain text enters through Words() and attributes alone, which escape it.
class Markup {
 public:
  Markup() = default;

  /// Markup that the program itself wrote; never for anything that was read.
  static Markup Own(std::string_view markup);

  const std::string& Text() const { return text_; }
  Markup& operator+=(const Markup& other);
  friend Markup operator+(Markup left, const Markup& right) { return left += right; }

 private:
  std::string text_;
};

/// Text that reads as it stands, whatever characters it holds.
Markup Words(std::string_view text);

/// The same for a name of several words joined by underscores, which a line may end after.
Markup JoinedName(std::string_view name);

struct Attribute {
  std::string_view name;
  std::string value;
};

/// <name attributes>content</name>.
Markup Element(std::string_view name, std::initializer_list<Attribute> attributes,
               const Markup& content = {});

/// <name class="style">content</name>; without the class where `style` is empty.
Markup Styled(std::string_view name, std::string_view style, const Markup& content);

}  // namespace telltale
