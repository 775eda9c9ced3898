#include "telltale/client/recording/ros/idl_definition.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace telltale {
namespace {

bool IsWordPart(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The words and signs of a text, without what is said to people and to the preprocessor, and
/// without the lines between the files that ros2idl joins.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) { Next(); }

  bool AtEnd() const { return token_.empty(); }
  bool Is(std::string_view token) const { return token_ == token; }

  std::string_view Take() {
    const std::string_view token = token_;
    Next();
    return token;
  }
  bool TakeIf(std::string_view token) {
    if (!Is(token)) return false;
    Next();
    return true;
  }

  /// Past the token, or past the brackets that it opens.
  void Skip() {
    int depth = 0;
    do {
      if (Is("{") || Is("(")) ++depth;
      if (Is("}") || Is(")")) --depth;
      Next();
    } while (depth > 0 && !AtEnd());
  }
  void SkipPast(std::string_view token) {
    while (!AtEnd() && !Is(token)) Skip();
    TakeIf(token);
  }

  void Next() {
    SkipBlanks();
    std::size_t length = text_.empty() ? 0 : 1;
    if (length > 0 && IsWordPart(text_[0])) {
      while (length < text_.size() && IsWordPart(text_[length])) ++length;
    } else if (text_.starts_with("::")) {
      length = 2;
    } else if (text_.starts_with('"')) {
      while (length < text_.size() && text_[length] != '"') length += text_[length] == '\\' ? 2 : 1;
      length = std::min(length + 1, text_.size());
    }
    token_ = text_.substr(0, length);
    text_.remove_prefix(length);
  }

 private:
  void SkipBlanks() {
    for (;;) {
      const std::size_t blanks = text_.find_first_not_of(" \t\r\n");
      text_.remove_prefix(std::min(blanks, text_.size()));
      if (text_.starts_with("/*")) {
        text_.remove_prefix(std::min(text_.find("*/", 2), text_.size() - 2) + 2);
      } else if (text_.starts_with("//") || text_.starts_with('#') || text_.starts_with("===") ||
                 text_.starts_with("IDL:")) {
        text_.remove_prefix(std::min(text_.find('\n'), text_.size()));
      } else {
        return;
      }
    }
  }

  std::string_view text_;
  std::string_view token_;
};

/// A type as .msg spells it: "float64" and, of an array, "[9]".
struct MsgType {
  std::string name;
  std::string array;
};

class Definition {
 public:
  explicit Definition(std::string_view idl) : tokens_(idl) {}

  std::string Text() && {
    while (!tokens_.AtEnd()) TakeDeclaration();
    return std::move(text_);
  }

 private:
  void TakeDeclaration() {
    if (SkipAnnotation()) return;
    if (tokens_.TakeIf("module")) {
      modules_.emplace_back(tokens_.Take());
      tokens_.TakeIf("{");
    } else if (tokens_.TakeIf("}")) {
      if (!modules_.empty()) modules_.pop_back();
    } else if (tokens_.TakeIf("typedef")) {
      if (const auto type = TakeType()) {
        const std::string name(tokens_.Take());
        typedefs_[name] = {type->name, type->array + TakeLength()};
      }
      tokens_.SkipPast(";");
    } else if (tokens_.TakeIf("struct")) {
      TakeStructure();
    } else if (tokens_.Is("const") || tokens_.Is("union") || tokens_.Is("enum")) {
      tokens_.SkipPast(";");
    } else {
      tokens_.Next();  // a stray sign
    }
  }

  void TakeStructure() {
    const std::string name(tokens_.Take());
    if (!tokens_.TakeIf("{")) return tokens_.SkipPast(";");
    std::string fields;
    while (!tokens_.AtEnd() && !tokens_.TakeIf("}")) {
      if (SkipAnnotation()) continue;
      const auto type = TakeType();
      while (type && !tokens_.AtEnd() && !tokens_.Is(";") && !tokens_.Is("}")) {
        const std::string field(tokens_.Take());
        fields += type->name + type->array + TakeLength() + ' ' + field + '\n';
        tokens_.TakeIf(",");
      }
      if (!tokens_.Is("}")) tokens_.SkipPast(";");
    }
    text_ += "MSG: " + Package() + '/' + name + '\n' + fields + "===\n";
  }

  bool SkipAnnotation() {
    if (!tokens_.TakeIf("@")) return false;
    tokens_.Next();
    if (tokens_.Is("(")) tokens_.Skip();
    return true;
  }

  std::optional<MsgType> TakeType() {
    if (tokens_.TakeIf("sequence")) {
      if (!tokens_.TakeIf("<") || depth_ == kDeepest) return std::nullopt;
      ++depth_;
      const auto element = TakeType();
      --depth_;
      tokens_.SkipPast(">");
      if (!element) return std::nullopt;
      return MsgType{element->name, "[]"};
    }
    std::string name = TakeName();
    if (name == "string" && tokens_.TakeIf("<")) tokens_.SkipPast(">");
    if (const auto known = typedefs_.find(name); known != typedefs_.end()) return known->second;
    if (const auto built_in = BuiltIn(name)) return MsgType{std::string(*built_in), ""};
    if (name.find('/') == std::string::npos) name = Package() + '/' + name;
    return MsgType{std::move(name), ""};
  }

  /// "long long", "sensor_msgs/Imu", "Point": words that belong together, without "msg".
  std::string TakeName() {
    std::string name;
    tokens_.TakeIf("::");
    for (bool goes_on = true; goes_on && !tokens_.AtEnd();) {
      const std::string_view word = tokens_.Take();
      if (word != "msg") name += word;
      if (tokens_.TakeIf("::")) {
        if (!name.empty() && !name.ends_with('/')) name += '/';
      } else {
        goes_on = word == "unsigned" || (word == "long" && tokens_.Is("long"));
        if (goes_on) name += ' ';
      }
    }
    return name;
  }

  static std::optional<std::string_view> BuiltIn(std::string_view name) {
    using Pair = std::pair<std::string_view, std::string_view>;
    constexpr std::array kNames = {Pair("double", "float64"),
                                   Pair("float", "float32"),
                                   Pair("boolean", "bool"),
                                   Pair("octet", "uint8"),
                                   Pair("char", "uint8"),
                                   Pair("short", "int16"),
                                   Pair("unsigned short", "uint16"),
                                   Pair("long", "int32"),
                                   Pair("unsigned long", "uint32"),
                                   Pair("long long", "int64"),
                                   Pair("string", "string"),
                                   Pair("unsigned long long", "uint64"),
                                   Pair("int8", "int8"),
                                   Pair("uint8", "uint8"),
                                   Pair("int16", "int16"),
                                   Pair("uint16", "uint16"),
                                   Pair("int32", "int32"),
                                   Pair("uint32", "uint32"),
                                   Pair("int64", "int64"),
                                   Pair("uint64", "uint64")};
    for (const auto& [idl, msg] : kNames) {
      if (idl == name) return msg;
    }
    return std::nullopt;
  }

  /// "[9]" behind a name, or nothing.
  std::string TakeLength() {
    if (!tokens_.TakeIf("[")) return {};
    std::string length = '[' + std::string(tokens_.Take()) + ']';
    tokens_.TakeIf("]");
    return length;
  }

  std::string Package() const { return modules_.empty() ? std::string() : modules_.front(); }

  static constexpr int kDeepest = 16;

  Tokens tokens_;
  std::vector<std::string> modules_;
  std::map<std::string, MsgType> typedefs_;
  int depth_ = 0;
  std::string text_;
};

}  // namespace

std::string RosDefinitionOfIdl(std::string_view idl) {
  return Definition(idl).Text();
}

}  // namespace telltale
