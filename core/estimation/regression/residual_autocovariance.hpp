#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// Autocovariances of the residuals of one equation, by lag in rows or in test-function supports.
/// Supports overlap and disturbances last, so their residuals are autocorrelated.

/// Runs of items whose places follow each other at `stride`. Autocovariances are taken within runs
/// only: runs are separated by a gap, or by rows that do not enter the equation.
std::vector<RowRange> RunsOf(std::span<const std::size_t> places, std::size_t stride);

/// Residuals per effective independent residual, at least one: 1 + 2 sum of their autocorrelations,
/// as long as sums of two successive ones stay positive. docs/concepts/model.md (64).
/// Source: Geyer, "Practical Markov chain Monte Carlo",
/// Statistical Science 7 (1992), the initial positive sequence.
double RowsPerIndependentRow(const Eigen::VectorXd& residual, std::span<const RowRange> runs);

/// Mean products of residuals l apart, l = 0 .. lags - 1; zero for lags that no run has.
Eigen::VectorXd Autocovariance(std::span<const RowRange> runs, const Eigen::VectorXd& residual,
                               std::size_t lags);

/// Autocovariances of which Correlate makes no negative variance, however short the runs: products
/// of residuals l apart divided by the number of residuals instead of pairs, with Bartlett's
/// weights. Long correlations are biased low. Autocovariance() is unbiased, but may not be positive
/// semidefinite.
/// Source: Newey and West, "A simple, positive semi-definite, heteroskedasticity and
/// autocorrelation consistent covariance matrix", Econometrica 55 (1987).
Eigen::VectorXd DefiniteAutocovariance(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& residual, std::size_t lags);

/// V X, V the covariance of residuals with these autocovariances: zero at longer lags and between
/// runs. Shapes: X and the result residuals x any number of columns.
Eigen::MatrixXd Correlate(std::span<const RowRange> runs, const Eigen::VectorXd& autocovariance,
                          const Eigen::MatrixXd& X);

/// The autocovariances of the residuals of a fit whose errors have these autocovariances:
/// e = (I - H) errors with H = response Z', for l = 0 .. lags - 1. They are smaller, the more so
/// the longer the errors last, since coefficients take up slow changes. Shapes: response and Z
/// residuals x p.
Eigen::VectorXd AutocovarianceAfterFit(std::span<const RowRange> runs,
                                       const Eigen::VectorXd& autocovariance,
                                       const Eigen::MatrixXd& response, const Eigen::MatrixXd& Z,
                                       std::size_t lags);

}  // namespace telltale
