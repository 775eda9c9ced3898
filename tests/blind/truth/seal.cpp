#include "seal.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "random_stream.hpp"

namespace blind::truth {
namespace {

constexpr std::string_view kMark = "sealed label 1\n";
constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kDigestBytes = 8;

RandomStream Stream(std::string_view name) {
  return RandomStream(0x5ea1ed1abe15u).For(name);
}

/// FNV-1a, 64 bits.
std::uint64_t Digest(std::string_view text) {
  std::uint64_t digest = 0xcbf29ce484222325u;
  for (const char letter : text) {
    digest = (digest ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  }
  return digest;
}

std::string WithDigest(std::string text) {
  const std::uint64_t digest = Digest(text);
  for (std::size_t byte = 0; byte < kDigestBytes; ++byte) {
    text += static_cast<char>(digest >> (8 * byte) & 0xff);
  }
  return text;
}

std::size_t DigitValue(char digit) {
  const std::size_t value = kDigits.find(digit);
  if (value == std::string_view::npos) throw std::invalid_argument("a seal is hexadecimal");
  return value;
}

}  // namespace

std::string Sealed(std::string_view label, std::string_view name) {
  if (label.size() > kSealedBytes)
    throw std::invalid_argument("a label this long cannot be sealed");
  std::string plain(label);
  plain.resize(kSealedBytes, ' ');
  RandomStream stream = Stream(name);
  std::string sealed(kMark);
  for (const char letter : WithDigest(plain)) {
    const auto byte = static_cast<unsigned char>(letter) ^ (stream.Bits() & 0xff);
    sealed += kDigits[byte >> 4];
    sealed += kDigits[byte & 0xf];
  }
  return sealed + '\n';
}

std::string Unsealed(std::string_view sealed, std::string_view name) {
  constexpr std::size_t kDigitsSealed = 2 * (kSealedBytes + kDigestBytes);
  if (!sealed.starts_with(kMark)) throw std::invalid_argument("this is no sealed label");
  sealed.remove_prefix(kMark.size());
  if (sealed.size() < kDigitsSealed) throw std::invalid_argument("the seal is cut short");
  RandomStream stream = Stream(name);
  std::string plain;
  for (std::size_t digit = 0; digit < kDigitsSealed; digit += 2) {
    const std::size_t byte = DigitValue(sealed[digit]) << 4 | DigitValue(sealed[digit + 1]);
    plain += static_cast<char>(byte ^ (stream.Bits() & 0xff));
  }
  if (WithDigest(plain.substr(0, kSealedBytes)) != plain) {
    throw std::invalid_argument("the seal is broken, or of another case");
  }
  plain.resize(kSealedBytes);
  plain.resize(plain.find_last_not_of(' ') + 1);
  return plain;
}

}  // namespace blind::truth
