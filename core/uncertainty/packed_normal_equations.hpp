#pragma once

#include <cstddef>

namespace telltale {

/// Normal equations A x = b of a least-squares problem with r unknowns, as one run of numbers: the
/// lower triangle of [W e]'[W e] column by column, without its last corner. Column j holds A_jj ..
/// A_(r-1)j and then b_j, so adding a row, adding two systems and eliminating are plain loops over
/// contiguous memory, and the sum over a unit of rows is 104 numbers where r is 13.
constexpr std::size_t PackedLength(std::size_t r) {
  return (r + 1) * (r + 2) / 2 - 1;
}

/// system += weight * (row of W, row of e)' (row of W, row of e); row holds r + 1 numbers.
void AddRow(const double* row, std::size_t r, double weight, double* system);

/// sum += weight * system.
void AddSystem(const double* system, std::size_t r, double weight, double* sum);

/// A becomes its Cholesky factor L and b becomes L^-1 b, in place; false, with the system spoilt,
/// when A is not positive definite or its pivots differ by more than a factor of 1e10. W is taken
/// to be scaled so that A of a regular system is near a multiple of the identity.
bool Factorise(std::size_t r, double* system);

/// x = L'^-1 (L^-1 b), from a factorised system.
void Substitute(const double* factorised, std::size_t r, double* x);

/// score = b - A x, what x leaves of the right-hand side.
void ScoreAt(const double* system, std::size_t r, const double* x, double* score);

}  // namespace telltale
