#pragma once

namespace telltale {

constexpr double Square(double x) {
  return x * x;
}

}  // namespace telltale
