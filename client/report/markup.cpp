#include "telltale/client/report/markup.hpp"

namespace telltale {
namespace {

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

}  // namespace

Markup Markup::Own(std::string_view markup) {
  Markup own;
  own.text_ = markup;
  return own;
}

Markup& Markup::operator+=(const Markup& other) {
  text_ += other.text_;
  return *this;
}

Markup Words(std::string_view text) {
  return Markup::Own(Escaped(text));
}

Markup JoinedName(std::string_view name) {
  const auto end = name.find('_');
  if (end == std::string_view::npos) return Words(name);
  return Words(name.substr(0, end + 1)) + Markup::Own("<wbr>") + JoinedName(name.substr(end + 1));
}

Markup Element(std::string_view name, std::initializer_list<Attribute> attributes,
               const Markup& content) {
  std::string text = "<" + std::string(name);
  for (const Attribute& attribute : attributes) {
    text.append(" ").append(attribute.name).append("=\"").append(Escaped(attribute.value));
    text += '"';
  }
  text.append(">").append(content.Text()).append("</").append(name).append(">");
  return Markup::Own(text);
}

Markup Styled(std::string_view name, std::string_view style, const Markup& content) {
  if (style.empty()) return Element(name, {}, content);
  return Element(name, {{"class", std::string(style)}}, content);
}

}  // namespace telltale
