#pragma once

#include <string>

#include <tl/expected.hpp>

namespace telltale {

/// A wire, file or configuration error: which field, the value it had, and what is allowed.
struct CodecError {
  std::string field;
  std::string value;
  std::string allowed;
  std::string where = {};  ///< "file:line" or "file" where the source is a text, else empty

  /// "where: field = value: allowed ...", for a person, in one line. At most 200 characters of the
  /// value are shown.
  std::string Message() const;
};

template <class T>
using Decoded = tl::expected<T, CodecError>;

}  // namespace telltale
