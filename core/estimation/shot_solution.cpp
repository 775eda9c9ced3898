#include "telltale/core/estimation/shot_solution.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <ceres/ceres.h>

#include "telltale/core/estimation/weak_iv.hpp"
#include "telltale/core/median.hpp"

namespace telltale {
namespace {

/// One shot's share of the sum, as a function of theta and of the state it starts in.
class ShotCost : public ceres::CostFunction {
 public:
  ShotCost(const ShotPlan& plan, const Shot& shot, const SharedUnknowns& unknowns,
           const Yardstick& yardstick)
      : plan_(plan), shot_(shot), unknowns_(unknowns), yardstick_(yardstick) {
    set_num_residuals(static_cast<int>(shot.Residuals()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.Size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(ShotState::SizeAtCompileTime));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], unknowns_.Size());
    const Eigen::Map<const ShotState> start(parameters[1]);
    const auto miss =
        Shoot(plan_, shot_, unknowns_, theta, start, yardstick_, jacobians != nullptr);
    if (!miss) return false;
    std::copy_n(miss->residual.data(), miss->residual.size(), residuals);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      std::copy_n(miss->by_shared.data(), miss->by_shared.size(), jacobians[0]);
    }
    if (jacobians[1] != nullptr) {
      std::copy_n(miss->by_start.data(), miss->by_start.size(), jacobians[1]);
    }
    return true;
  }

 private:
  const ShotPlan& plan_;
  const Shot& shot_;
  const SharedUnknowns& unknowns_;
  const Yardstick& yardstick_;
};

class LeashCost : public ceres::CostFunction {
 public:
  explicit LeashCost(const Leash& leash) : leash_(leash) {
    set_num_residuals(static_cast<int>(leash.centre.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(leash.centre.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index P = leash_.centre.size();
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], P);
    Eigen::Map<Eigen::VectorXd>(residuals, P) = leash_.weight.cwiseProduct(theta - leash_.centre);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix>(jacobians[0], P, P) = leash_.weight.asDiagonal();
    }
    return true;
  }

 private:
  const Leash& leash_;
};

/// How many times their usual size values are by their median, at least once.
double TimesUsual(std::vector<double> values, double usual_median) {
  return values.empty() ? 1.0 : std::max(1.0, Median(std::move(values)) / usual_median);
}

}  // namespace

Leash LeashOn(const PreparedDataset& dataset, const SharedUnknowns& unknowns,
              const Eigen::VectorXd& centre) {
  constexpr double kThroughSpreadS = 1.0;
  Leash leash{centre, Eigen::VectorXd::Ones(centre.size())};
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
      leash.weight[next++] =
          kThroughSpreadS * std::sqrt(squares[static_cast<Eigen::Index>(column)]) / spread;
    }
  }
  return leash;
}

ShotSolution::ShotSolution(const ShotPlan& plan, const SharedUnknowns& unknowns, const Leash& leash,
                           double knee, const Eigen::VectorXd& theta)
    : plan_(plan), unknowns_(unknowns), leash_(leash), knee_(knee), theta_(theta) {
  for (const Shot& shot : plan.shots) starts_.push_back(shot.guess);
}

void ShotSolution::MoveTo(const Eigen::VectorXd& theta, const std::vector<ShotState>& starts) {
  theta_ = theta;
  starts_ = starts;
}

bool ShotSolution::RunsAway() const {
  for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
    if (!Sight(i, {}, false)) return true;
  }
  return false;
}

std::optional<Miss> ShotSolution::Sight(std::size_t shot, const Yardstick& yardstick,
                                        bool with_derivatives) const {
  return Shoot(plan_, plan_.shots[shot], unknowns_, theta_, starts_[shot], yardstick,
               with_derivatives);
}

Yardstick ShotSolution::Measure() const {
  constexpr double kMedianDistance = 1.1774;  // of a unit normal in the plane
  constexpr double kMedianSize = 0.6745;      // of a unit normal
  std::vector<double> distances;
  std::vector<double> sizes;
  ForEachResidual([&](const auto& residual) {
    (residual.size() == 2 ? distances : sizes).push_back(residual.norm());
  });
  return {TimesUsual(std::move(distances), kMedianDistance),
          TimesUsual(std::move(sizes), kMedianSize), knee_};
}

std::size_t ShotSolution::CountPast(const Yardstick& yardstick) const {
  std::size_t past = 0;
  ForEachResidual([&](const auto& residual) {
    const double size = residual.size() == 2 ? yardstick.position : yardstick.heading;
    past += residual.norm() > yardstick.knee * size ? 1 : 0;
  });
  return past;
}

double ShotSolution::Sum(const Yardstick& yardstick) const {
  double sum = leash_.weight.cwiseProduct(theta_ - leash_.centre).squaredNorm();
  for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
    const auto miss = Sight(i, yardstick, false);
    if (!miss) return std::numeric_limits<double>::infinity();
    sum += miss->residual.squaredNorm();
  }
  return sum;
}

bool ShotSolution::Descend(const Yardstick& yardstick, double tolerance, int iterations,
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
    problem.SetParameterLowerBound(theta_.data(), 0, kLeastTimeConstantS);
    problem.SetParameterUpperBound(theta_.data(), 0, kLongestLagS);
  }
  for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
    problem.AddResidualBlock(
        std::make_unique<ShotCost>(plan_, plan_.shots[i], unknowns_, yardstick).release(), nullptr,
        theta_.data(), starts_[i].data());
    order->AddElementToGroup(starts_[i].data(), 0);
  }
  problem.AddResidualBlock(std::make_unique<LeashCost>(leash_).release(), nullptr, theta_.data());
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
void ShotSolution::ForEachResidual(Visit visit) const {
  for (std::size_t i = 0; i < plan_.shots.size(); ++i) {
    const auto miss = Sight(i, {}, false);
    if (!miss) continue;
    Eigen::Index row = 0;
    for (const ShotNode& node : plan_.shots[i].nodes) {
      if (node.fix) {
        visit(miss->residual.segment(row, 2));
        row += 2;
      }
      if (node.heading) visit(miss->residual.segment(row++, 1));
    }
  }
}

}  // namespace telltale
