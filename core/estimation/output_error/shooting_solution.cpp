#include "telltale/core/estimation/output_error/shooting_solution.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <ceres/ceres.h>

#include "telltale/core/base/median.hpp"
#include "telltale/core/vessel/thruster_response.hpp"

namespace telltale {
namespace {

/// One shooting segment's residuals as a function of theta and of its initial state.
class ShootingSegmentCost : public ceres::CostFunction {
 public:
  ShootingSegmentCost(const ShootingPlan& plan, const ShootingSegment& shooting_segment,
                      const SharedUnknowns& unknowns, const NoiseScale& noise_scale)
      : plan_(plan),
        shooting_segment_(shooting_segment),
        unknowns_(unknowns),
        noise_scale_(noise_scale) {
    set_num_residuals(static_cast<int>(shooting_segment.Residuals()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.Size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(ShootingState::SizeAtCompileTime));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], unknowns_.Size());
    const Eigen::Map<const ShootingState> start(parameters[1]);
    const auto shooting_residual = ComputeShootingResidual(
        plan_, shooting_segment_, unknowns_, theta, start, noise_scale_, jacobians != nullptr);
    if (!shooting_residual) return false;
    std::copy_n(shooting_residual->residual.data(), shooting_residual->residual.size(), residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      std::copy_n(shooting_residual->by_shared.data(), shooting_residual->by_shared.size(),
                  jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      std::copy_n(shooting_residual->by_start.data(), shooting_residual->by_start.size(),
                  jacobians[1]);
    }
    return true;
  }

 private:
  const ShootingPlan& plan_;
  const ShootingSegment& shooting_segment_;
  const SharedUnknowns& unknowns_;
  const NoiseScale& noise_scale_;
};

class RidgePriorCost : public ceres::CostFunction {
 public:
  explicit RidgePriorCost(const RidgePrior& ridge_prior) : ridge_prior_(ridge_prior) {
    set_num_residuals(static_cast<int>(ridge_prior.centre.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(ridge_prior.centre.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index P = ridge_prior_.centre.size();
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], P);
    Eigen::Map<Eigen::VectorXd>(residuals, P) =
        ridge_prior_.weight.cwiseProduct(theta - ridge_prior_.centre);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix>(jacobians[0], P, P) = ridge_prior_.weight.asDiagonal();
    }
    return true;
  }

 private:
  const RidgePrior& ridge_prior_;
};

/// The median of the values over the median that is usual, at least one.
double RatioToUsualMedian(std::vector<double> values, double usual_median) {
  return values.empty() ? 1.0 : std::max(1.0, Median(std::move(values)) / usual_median);
}

}  // namespace

RidgePrior MakeRidgePrior(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
                          const Eigen::VectorXd& centre) {
  constexpr double kThroughSpreadS = 1.0;
  RidgePrior ridge_prior{centre, Eigen::VectorXd::Ones(centre.size())};
  const auto n = static_cast<double>(dataset.rows.size());
  for (const Equation equation : kEquations) {
    const auto regressors = Regressors(equation, unknowns.parameterization);
    Eigen::VectorXd row(static_cast<Eigen::Index>(regressors.size()));
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(row.size());
    double sum = 0.0;
    double square = 0.0;
    for (const PreparedRow& at : dataset.rows) {
      FillRow(equation, unknowns.parameterization, at.nu, unknowns.dead_zone.Apply(at.delta),
              {row.data(), regressors.size()});
      squares += row.cwiseAbs2() / n;
      sum += ComponentOf(at.nu, equation) / n;
      square += ComponentOf(at.nu, equation) * ComponentOf(at.nu, equation) / n;
    }
    const double spread = std::sqrt(std::max(square - sum * sum, 1e-12));
    Eigen::Index next = unknowns.First(equation);
    for (const std::size_t column : unknowns.columns[IndexOf(equation)]) {
      ridge_prior.weight[next++] =
          kThroughSpreadS * std::sqrt(squares[static_cast<Eigen::Index>(column)]) / spread;
    }
  }
  return ridge_prior;
}

ShootingSolution::ShootingSolution(const ShootingPlan& plan, const SharedUnknowns& unknowns,
                                   const RidgePrior& ridge_prior, double huber_threshold,
                                   const Eigen::VectorXd& theta)
    : plan_(plan),
      unknowns_(unknowns),
      ridge_prior_(ridge_prior),
      huber_threshold_(huber_threshold),
      theta_(theta) {
  for (const ShootingSegment& shooting_segment : plan.shooting_segments)
    starts_.push_back(shooting_segment.guess);
}

void ShootingSolution::MoveTo(const Eigen::VectorXd& theta,
                              const std::vector<ShootingState>& starts) {
  theta_ = theta;
  starts_ = starts;
}

bool ShootingSolution::Diverges() const {
  for (std::size_t i = 0; i < plan_.shooting_segments.size(); ++i) {
    if (!ComputeResidual(i, {}, false)) return true;
  }
  return false;
}

std::optional<ShootingResidual> ShootingSolution::ComputeResidual(std::size_t shooting_segment,
                                                                  const NoiseScale& noise_scale,
                                                                  bool with_derivatives) const {
  return ComputeShootingResidual(plan_, plan_.shooting_segments[shooting_segment], unknowns_,
                                 theta_, starts_[shooting_segment], noise_scale, with_derivatives);
}

NoiseScale ShootingSolution::Measure() const {
  constexpr double kMedianDistance = 1.1774;  // of a unit normal in the plane
  constexpr double kMedianSize = 0.6745;      // of the absolute value of a unit normal
  std::vector<double> distances;
  std::vector<double> sizes;
  ForEachResidual([&](const auto& residual) {
    (residual.size() == 2 ? distances : sizes).push_back(residual.norm());
  });
  return {RatioToUsualMedian(std::move(distances), kMedianDistance),
          RatioToUsualMedian(std::move(sizes), kMedianSize), huber_threshold_};
}

std::size_t ShootingSolution::CountBeyondThreshold(const NoiseScale& noise_scale) const {
  std::size_t beyond = 0;
  ForEachResidual([&](const auto& residual) {
    const double size = residual.size() == 2 ? noise_scale.position : noise_scale.heading;
    beyond += residual.norm() > noise_scale.huber_threshold * size ? 1 : 0;
  });
  return beyond;
}

double ShootingSolution::Sum(const NoiseScale& noise_scale) const {
  double sum = ridge_prior_.weight.cwiseProduct(theta_ - ridge_prior_.centre).squaredNorm();
  for (std::size_t i = 0; i < plan_.shooting_segments.size(); ++i) {
    const auto shooting_residual = ComputeResidual(i, noise_scale, false);
    if (!shooting_residual) return std::numeric_limits<double>::infinity();
    sum += shooting_residual->residual.squaredNorm();
  }
  return sum;
}

bool ShootingSolution::Descend(const NoiseScale& noise_scale, double tolerance, int iterations,
                               std::optional<Eigen::Index> held) {
  ceres::Problem problem;
  auto* order = new ceres::ParameterBlockOrdering;  // the solver's options own it
  problem.AddParameterBlock(theta_.data(), static_cast<int>(theta_.size()));
  order->AddElementToGroup(theta_.data(), 1);
  if (held) {
    const std::vector<int> constant = {static_cast<int>(*held)};
    problem.SetManifold(theta_.data(), std::make_unique<ceres::SubsetManifold>(
                                           static_cast<int>(theta_.size()), constant)
                                           .release());
  }
  if (unknowns_.lagging) {
    problem.SetParameterLowerBound(theta_.data(), 0, kShortestTimeConstantS);
    problem.SetParameterUpperBound(theta_.data(), 0, kLongestTimeConstantS);
  }
  for (std::size_t i = 0; i < plan_.shooting_segments.size(); ++i) {
    problem.AddResidualBlock(std::make_unique<ShootingSegmentCost>(
                                 plan_, plan_.shooting_segments[i], unknowns_, noise_scale)
                                 .release(),
                             nullptr, theta_.data(), starts_[i].data());
    order->AddElementToGroup(starts_[i].data(), 0);
  }
  problem.AddResidualBlock(std::make_unique<RidgePriorCost>(ridge_prior_).release(), nullptr,
                           theta_.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering.reset(order);
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE;
}

template <class Visit>
void ShootingSolution::ForEachResidual(Visit visit) const {
  for (std::size_t i = 0; i < plan_.shooting_segments.size(); ++i) {
    const auto shooting_residual = ComputeResidual(i, {}, false);
    if (!shooting_residual) continue;
    Eigen::Index row = 0;
    for (const ShootingNode& node : plan_.shooting_segments[i].nodes) {
      if (node.fix) {
        visit(shooting_residual->residual.segment(row, 2));
        row += 2;
      }
      if (node.heading) visit(shooting_residual->residual.segment(row++, 1));
    }
  }
}

}  // namespace telltale
