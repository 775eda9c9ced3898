#pragma once

#include <vector>

namespace telltale {

/// Shares of the value of a coalition by its members' Shapley values: each member's contribution,
/// averaged over all orders in which members may join. The shares add up to one; all are zero where
/// the whole coalition has no value.
/// `values[s]` is the value of the subset s, bit i of s being member i; `values[0]` is that of no
/// member. Shapes: 2^n values, n in [1, 3] members; n shares.
/// Source: L. S. Shapley, A value for n-person games, 1953.
std::vector<double> ShapleyShares(const std::vector<double>& values);

}  // namespace telltale
