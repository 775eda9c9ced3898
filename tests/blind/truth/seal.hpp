#pragma once

#include <string>
#include <string_view>

namespace blind::truth {

/// Seals a label so that neither eye nor grep reads it by accident: padded to one length,
/// enciphered by a keyed stream, with a digest. The key stands in the source: this keeps nobody out
/// who wants in. Throws std::invalid_argument for more than kSealedBytes.
std::string Sealed(std::string_view label, std::string_view name);

/// What was sealed under that name; throws std::invalid_argument where text, name or digest do not
/// fit.
std::string Unsealed(std::string_view sealed, std::string_view name);

inline constexpr std::size_t kSealedBytes = 2048;

}  // namespace blind::truth
