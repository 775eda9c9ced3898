#include "telltale/client/exchange/shortest_number.hpp"

#include <array>
#include <charconv>

namespace telltale {

std::string ShortestNumber(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace telltale
