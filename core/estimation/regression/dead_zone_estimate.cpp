#include "telltale/core/estimation/regression/dead_zone_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/parallel.hpp"
#include "telltale/core/estimation/regression/lagged_regression.hpp"
#include "telltale/core/estimation/regression/triangular_factor.hpp"

namespace telltale {
namespace {

constexpr double kGridStep = 0.05;
constexpr std::size_t kGridPoints = 7;  // 0 to kWidestDeadZone
constexpr double kFinestStep = 1e-5;

/// Both limits as sizes, so that the search sees a square.
struct Widths {
  double forward = 0.0;
  double reverse = 0.0;

  DeadZone Limits() const { return {forward, -reverse}; }
  bool Allowed() const {
    return std::min(forward, reverse) >= 0.0 && std::max(forward, reverse) <= kWidestDeadZone;
  }
};

/// n log RSS, the misfit of one equation as -2 log likelihood with its variance profiled out. Data
/// made by the model itself leave nothing; the floor keeps the logarithm finite.
double Misfit(double squares, double total_squares, Eigen::Index rows) {
  constexpr double kRounding = 1e-24;
  return static_cast<double>(rows) * std::log(squares + kRounding * total_squares);
}

Eigen::MatrixXd Columns(const Eigen::MatrixXd& phi, const std::vector<std::size_t>& columns) {
  Eigen::MatrixXd selected(phi.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    selected.col(static_cast<Eigen::Index>(j)) = phi.col(static_cast<Eigen::Index>(columns[j]));
  }
  return selected;
}

/// The same columns for every dead zone, so that misfits compare; ones a wide zone silences do no
/// harm to a rank-revealing solve.
double StaticMisfit(const EquationProblem& problem, const Excitation& excitation) {
  const TriangularFactor factor =
      Triangularise(Columns(problem.phi, excitation.excited), problem.y);
  const Eigen::VectorXd theta = factor.R.completeOrthogonalDecomposition().solve(factor.z);
  const double squares = factor.rho * factor.rho + (factor.z - factor.R * theta).squaredNorm();
  return Misfit(squares, problem.y.squaredNorm(), problem.y.size());
}

class DeadZoneSearch {
 public:
  DeadZoneSearch(const PreparedDataset& dataset, const RegressionOptions& options,
                 std::size_t threads)
      : dataset_(dataset), options_(options), threads_(threads) {}

  /// Chooses the equations and columns, from their excitation without a dead zone.
  std::optional<Refusal> Prepare(const ExcitationLimits& limits) {
    std::optional<Refusal> first_refusal;
    bool any = false;
    for (const EquationProblem& problem : Problems()) {
      auto excitation = Assess(problem, limits);
      if (excitation) {
        excitations_[IndexOf(problem.equation)] = *std::move(excitation);
        any = true;
      } else if (!first_refusal) {
        first_refusal = excitation.error();
      }
    }
    return any ? std::nullopt : first_refusal;
  }

  double Misfit(const Widths& widths) const {
    return Dynamic() ? LaggedMisfit(widths) : StaticMisfit(widths);
  }

  std::vector<double> Misfits(std::span<const Widths> candidates) const {
    std::vector<double> misfits(candidates.size());
    ForEachIndex(candidates.size(), threads_,
                 [&](std::size_t i) { misfits[i] = Misfit(candidates[i]); });
    return misfits;
  }

 private:
  bool Dynamic() const { return options_.structure == Structure::kFirstOrderDynamic; }

  RegressionOptions With(const Widths& widths) const {
    RegressionOptions options = options_;
    options.dead_zone = widths.Limits();
    return options;
  }

  std::array<EquationProblem, 3> Problems() const {
    RegressionOptions at_once = With({});
    at_once.structure = Structure::kStaticQuadratic;
    return BuildRegression(dataset_, at_once).equations;
  }

  double StaticMisfit(const Widths& widths) const {
    const RegressionProblem problem = BuildRegression(dataset_, With(widths));
    double sum = 0.0;
    for (std::size_t j = 0; j < excitations_.size(); ++j) {
      if (!excitations_[j]) continue;
      sum += telltale::StaticMisfit(problem.equations[j], *excitations_[j]);
    }
    return sum;
  }

  double LaggedMisfit(const Widths& widths) const {
    const LaggedProblem problem = BuildLagged(dataset_, With(widths));
    const LaggedEstimate estimate = EstimateLagged(problem, excitations_);
    double sum = 0.0;
    for (std::size_t j = 0; j < excitations_.size(); ++j) {
      if (!excitations_[j]) continue;
      const EquationEstimate& equation = *estimate.equations[j];
      const Eigen::VectorXd& y = problem.at_once.equations[j].y;
      sum += telltale::Misfit(equation.residual_variance * equation.degrees_of_freedom,
                              y.squaredNorm(), y.size());
    }
    return sum;
  }

  const PreparedDataset& dataset_;
  RegressionOptions options_;
  std::size_t threads_;
  std::array<std::optional<Excitation>, 3> excitations_;
};

struct Grid {
  std::vector<Widths> points;
  std::vector<double> misfits;

  std::size_t Best() const {
    return static_cast<std::size_t>(std::min_element(misfits.begin(), misfits.end()) -
                                    misfits.begin());
  }
};

Grid SearchGrid(const DeadZoneSearch& search) {
  Grid grid;
  for (std::size_t i = 0; i < kGridPoints; ++i) {
    for (std::size_t j = 0; j < kGridPoints; ++j) {
      grid.points.push_back({std::min(static_cast<double>(i) * kGridStep, kWidestDeadZone),
                             std::min(static_cast<double>(j) * kGridStep, kWidestDeadZone)});
    }
  }
  grid.misfits = search.Misfits(grid.points);
  return grid;
}

/// Moves to the best of eight neighbours while one is better, then halves the step.
Widths Refine(const DeadZoneSearch& search, Widths best, double misfit) {
  for (double step = 0.5 * kGridStep; step >= kFinestStep;) {
    std::vector<Widths> around;
    for (const double north : {-step, 0.0, step}) {
      for (const double east : {-step, 0.0, step}) {
        const Widths neighbour{best.forward + north, best.reverse + east};
        if ((north != 0.0 || east != 0.0) && neighbour.Allowed()) around.push_back(neighbour);
      }
    }
    const std::vector<double> misfits = search.Misfits(around);
    const auto least = std::min_element(misfits.begin(), misfits.end());
    if (*least < misfit) {
      best = around[static_cast<std::size_t>(least - misfits.begin())];
      misfit = *least;
    } else {
      step *= 0.5;
    }
  }
  return best;
}

/// The span of the profile of one limit over the grid: least and highest alike are of the grid, so
/// that its coarseness in the other limit is no contrast.
double Contrast(const Grid& grid, double Widths::*width) {
  std::map<double, double> profile;
  for (std::size_t k = 0; k < grid.points.size(); ++k) {
    const auto place = profile.try_emplace(grid.points[k].*width, grid.misfits[k]).first;
    place->second = std::min(place->second, grid.misfits[k]);
  }
  const auto [least, highest] =
      std::minmax_element(profile.begin(), profile.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  return highest->second - least->second;
}

DeadZoneLimit LimitOf(const Grid& grid, double Widths::*width, const Widths& best, double sign) {
  DeadZoneLimit limit;
  limit.estimate = best.*width > 0.0 ? sign * (best.*width) : 0.0;
  limit.contrast = Contrast(grid, width);
  limit.determined = limit.contrast > kLeastContrast && best.*width < kWidestDeadZone - kFinestStep;
  return limit;
}

}  // namespace

Result<DeadZoneEstimate> EstimateDeadZone(const PreparedDataset& dataset,
                                          const RegressionOptions& options,
                                          const ExcitationLimits& limits, std::size_t threads) {
  DeadZoneSearch search(dataset, options, threads);
  if (auto refusal = search.Prepare(limits)) return tl::unexpected(*refusal);
  const Grid grid = SearchGrid(search);
  const std::size_t start = grid.Best();
  const Widths best = Refine(search, grid.points[start], grid.misfits[start]);
  DeadZoneEstimate estimate;
  estimate.forward = LimitOf(grid, &Widths::forward, best, 1.0);
  estimate.reverse = LimitOf(grid, &Widths::reverse, best, -1.0);
  return estimate;
}

}  // namespace telltale
