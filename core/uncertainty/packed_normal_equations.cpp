#include "telltale/core/uncertainty/packed_normal_equations.hpp"

#include <algorithm>
#include <cmath>

namespace telltale {
namespace {

constexpr double kSmallestPivotRatio = 1e-10;

}  // namespace

void AddRow(const double* row, std::size_t r, double weight, double* system) {
  for (std::size_t j = 0; j < r; ++j) {
    const double factor = weight * row[j];
    for (std::size_t i = j; i <= r; ++i) *system++ += factor * row[i];
  }
}

void AddSystem(const double* system, std::size_t r, double weight, double* sum) {
  const std::size_t length = PackedLength(r);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < length; ++i) sum[i] += weight * system[i];
}

bool Factorise(std::size_t r, double* system) {
  double largest = 0.0;
  double* column = system;
  for (std::size_t j = 0; j < r; ++j) {
    const std::size_t below = r - j;  // rows below the diagonal, that of b among them
    const double pivot = column[0];
    largest = std::max(largest, pivot);
    if (!(pivot > kSmallestPivotRatio * largest)) return false;
    const double inverse_root = 1.0 / std::sqrt(pivot);
    for (std::size_t i = 0; i <= below; ++i) column[i] *= inverse_root;
    double* target = column + below + 1;
    for (std::size_t k = 1; k < below; ++k) {
      const double factor = column[k];
      for (std::size_t i = k; i <= below; ++i) *target++ -= factor * column[i];
    }
    column += below + 1;
  }
  return true;
}

void Substitute(const double* factorised, std::size_t r, double* x) {
  const double* column = factorised + PackedLength(r);
  for (std::size_t j = r; j-- > 0;) {
    const std::size_t below = r - j;
    column -= below + 1;
    double value = column[below];
    for (std::size_t i = 1; i < below; ++i) value -= column[i] * x[j + i];
    x[j] = value / column[0];
  }
}

void ScoreAt(const double* system, std::size_t r, const double* x, double* score) {
  std::fill_n(score, r, 0.0);
  for (std::size_t j = 0; j < r; ++j) {
    const std::size_t below = r - j;
    double value = system[below] - system[0] * x[j];
    for (std::size_t i = 1; i < below; ++i) {
      score[j + i] -= system[i] * x[j];
      value -= system[i] * x[j + i];
    }
    score[j] += value;
    system += below + 1;
  }
}

}  // namespace telltale
