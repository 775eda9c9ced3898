#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// How far apart the residuals of one equation still hang together, be they of rows or of windows,
/// which overlap and are pushed by what lasts: covariances by lag, in rows or windows.

/// Runs of items whose places follow each other at `stride`. Correlation is told within runs only:
/// beyond lies another segment, or rows that do not enter the equation.
std::vector<RowRange> RunsOf(std::span<const std::size_t> places, std::size_t stride);

/// How many neighbouring residuals say as much as one independent residual, at least one: 1 + 2 sum
/// of their autocorrelations, as long as pairs of them stay positive. docs/concepts/model.md (64).
/// Source: Geyer, "Practical Markov chain Monte Carlo",
/// Statistical Science 7 (1992), the initial positive sequence.
double RowsPerIndependentRow(const Eigen::VectorXd& residual, std::span<const RowRange> runs);

/// Mean products of residuals l apart, l = 0 .. lags - 1; zero for lags that no run has.
Eigen::VectorXd Autocovariance(std::span<const RowRange> runs, const Eigen::VectorXd& residual,
                               std::size_t lags);

/// Autocovariances of which Correlate makes no negative variance, however short the runs: products
/// of residuals l apart over all residuals instead of over pairs, weighed as Bartlett did. What
/// hangs together for long is told too weak, where means are told right on average but may be of no
/// process at all.
/// Source: Newey and West, "A simple, positive semi-definite, heteroskedasticity and
/// autocorrelation consistent covariance matrix", Econometrica 55 (1987).
Eigen::VectorXd DefiniteAutocovariance(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& residual, std::size_t lags);

/// V X, V the covariance of residuals with these autocovariances: zero at longer lags and between
/// runs. Shapes: X and the result residuals x any number of columns.
Eigen::MatrixXd Correlate(std::span<const RowRange> runs, const Eigen::VectorXd& autocovariance,
                          const Eigen::MatrixXd& X);

/// What residuals show of errors with these autocovariances once coefficients were fitted to them,
/// e = (I - H) errors with H = response Z', for l = 0 .. lags - 1: less, and the less the longer
/// errors last, since coefficients take up what changes slowly. Shapes: response and Z residuals x
/// p.
Eigen::VectorXd AutocovarianceAfterFit(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& autocovariance,
                                       const Eigen::MatrixXd& response, const Eigen::MatrixXd& Z,
                                       std::size_t lags);

}  // namespace telltale
