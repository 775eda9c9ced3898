#include "telltale/core/estimation/weak_form/weak_iv.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "telltale/core/base/contract.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/estimation/regression/residual_autocovariance.hpp"
#include "telltale/core/estimation/weak_form/instruments.hpp"
#include "telltale/core/estimation/weak_form/residual_whitening.hpp"

namespace telltale {
namespace {

constexpr std::size_t kResidualLags = 20;  // over which residuals of windows hang together

/// One equation weighed: b = G theta + e.
struct ProjectedEquation {
  std::size_t index = 0;
  std::vector<std::size_t> columns;
  Eigen::MatrixXd G;
  Eigen::VectorXd b;
};

using ProjectedEquations = std::vector<ProjectedEquation>;
using Thetas = std::vector<Eigen::VectorXd>;

Eigen::MatrixXd ProjectRegressors(const PreparedDataset& dataset, const WeakProblem& problem,
                                  const FilteredThrust& thrust, const ProjectedEquation& equation) {
  const RegressorRows rows = RowsOf(dataset, problem, thrust, kEquations[equation.index]);
  return Project(problem, problem.supports[equation.index], rows)(Eigen::all, equation.columns);
}

ProjectedEquations ProjectEquations(const PreparedDataset& dataset, const WeakProblem& problem,
                                    const FilteredThrust& thrust,
                                    const std::array<std::vector<std::size_t>, 3>& columns) {
  ProjectedEquations equations;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j].empty()) continue;
    ProjectedEquation equation{j, columns[j], {}, {}};
    equation.G = ProjectRegressors(dataset, problem, thrust, equation);
    equation.b = ProjectAcceleration(problem, problem.supports[j], dataset, kEquations[j]);
    equations.push_back(std::move(equation));
  }
  return equations;
}

VesselModel ModelWith(const WeakProblem& problem, const ProjectedEquations& equations,
                      const Thetas& thetas) {
  // Static, since its thrust comes lagged already.
  VesselModel model = VesselModel::OfZeros(Structure::kStaticQuadratic, problem.parameterization,
                                           Discretisation::kContinuous);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    Eigen::VectorXd& theta = model.theta[equations[i].index];
    for (std::size_t j = 0; j < equations[i].columns.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(equations[i].columns[j]);
      if (column < theta.size()) theta[column] = thetas[i][static_cast<Eigen::Index>(j)];
    }
  }
  return model;
}

/// Files one equation's steady terms under their recordings.
void AddConstantDisturbance(const WeakProblem& problem, std::size_t index,
                            const std::vector<std::size_t>& columns, const Eigen::VectorXd& theta,
                            std::vector<ConstantDisturbance>& disturbance_terms) {
  const std::size_t regressors = Regressors(kEquations[index], problem.parameterization).size();
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (columns[j] < regressors) continue;
    const std::size_t place = columns[j] - regressors;
    const std::size_t each = problem.disturbance_terms.PerRecording();
    disturbance_terms[place / each].terms(static_cast<Eigen::Index>(index),
                                          static_cast<Eigen::Index>(place % each)) =
        theta[static_cast<Eigen::Index>(j)];
  }
}

std::vector<ConstantDisturbance> ConstantDisturbancesWith(const WeakProblem& problem,
                                                          const ProjectedEquations& equations,
                                                          const Thetas& thetas) {
  std::vector<ConstantDisturbance> disturbance_terms(problem.disturbance_terms.recordings);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    AddConstantDisturbance(problem, equations[i].index, equations[i].columns, thetas[i],
                           disturbance_terms);
  }
  return disturbance_terms;
}

/// With what filtering before multiplying has lost of them.
ProjectedEquations Completed(const ProjectedEquations& equations,
                             const std::array<PredictedSupports, 3>& predicted) {
  ProjectedEquations completed = equations;
  for (ProjectedEquation& equation : completed)
    equation.G += predicted[equation.index].filtering_loss;
  return completed;
}

std::vector<Eigen::MatrixXd> InstrumentsOf(const ProjectedEquations& equations,
                                           const std::array<PredictedSupports, 3>& predicted) {
  std::vector<Eigen::MatrixXd> Z;
  for (const ProjectedEquation& equation : equations) Z.push_back(predicted[equation.index].Z);
  return Z;
}

Eigen::VectorXd Norms(const Eigen::MatrixXd& columns) {
  return columns.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
}

/// The solution of A x = c shrunk along directions that A hardly sees: what predicts the same
/// motion without the wild numbers that noise leaves there. Damping is relative to unit columns.
Eigen::VectorXd SolveRegularised(const Eigen::MatrixXd& A, const Eigen::VectorXd& c,
                                 const Eigen::VectorXd& z_norms, const Eigen::VectorXd& g_norms,
                                 double ridge) {
  const Eigen::MatrixXd S =
      z_norms.cwiseInverse().asDiagonal() * A * g_norms.cwiseInverse().asDiagonal();
  Eigen::MatrixXd normal = S.transpose() * S;
  normal.diagonal().array() += ridge * ridge;
  const Eigen::VectorXd right = S.transpose() * z_norms.cwiseInverse().asDiagonal() * c;
  return normal.ldlt().solve(right).cwiseQuotient(g_norms);
}

/// Each equation's damped solution with its instruments.
Thetas Regularised(const ProjectedEquations& equations, const std::vector<Eigen::MatrixXd>& Z,
                   double ridge) {
  Thetas thetas;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    thetas.push_back(SolveRegularised(Z[i].transpose() * equations[i].G,
                                      Z[i].transpose() * equations[i].b, Norms(Z[i]),
                                      Norms(equations[i].G), ridge));
  }
  return thetas;
}

Thetas SolveLeastSquares(const ProjectedEquations& equations) {
  Thetas thetas;
  for (const ProjectedEquation& equation : equations) {
    thetas.emplace_back(equation.G.colPivHouseholderQr().solve(equation.b));
  }
  return thetas;
}

/// How the weighed thrust responds to the time constant, times theta: g = dG/dtau theta.
std::vector<Eigen::MatrixXd> ThrustByLag(const PreparedDataset& dataset, const WeakProblem& problem,
                                         const ProjectedEquations& equations, const Thetas& thetas,
                                         double time_constant_s) {
  const double apart_s = 0.02 * time_constant_s;
  const FilteredThrust shorter = FilterThrust(dataset, problem, time_constant_s - apart_s);
  const FilteredThrust longer = FilterThrust(dataset, problem, time_constant_s + apart_s);
  std::vector<Eigen::MatrixXd> slopes;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::MatrixXd change = ProjectRegressors(dataset, problem, longer, equations[i]) -
                                   ProjectRegressors(dataset, problem, shorter, equations[i]);
    slopes.emplace_back(change * thetas[i] / (2.0 * apart_s));
  }
  return slopes;
}

/// One equation's instruments, the time constant's first if it is sought, and where among the
/// stacked unknowns what they tell of stands.
struct Share {
  std::vector<Eigen::Index> places;
  Eigen::MatrixXd Z;
};

/// The stacked linear system about the present estimate: unknowns are the change of the time
/// constant, if it is sought, and the coefficients.
struct System {
  Eigen::MatrixXd A;          // Z'G over the stacked unknowns
  Eigen::VectorXd c;          // Z'b
  std::vector<Share> shares;  // per equation
};

Eigen::MatrixXd Beside(const Eigen::VectorXd& first, const Eigen::MatrixXd& others) {
  Eigen::MatrixXd all(others.rows(), 1 + others.cols());
  all << first, others;
  return all;
}

System Stack(const ProjectedEquations& equations, const std::vector<Eigen::MatrixXd>& Z,
             const std::vector<Eigen::MatrixXd>& by_lag, const std::vector<double>& weights) {
  const bool lagging = !by_lag.empty();
  Eigen::Index P = lagging ? 1 : 0;
  for (const ProjectedEquation& equation : equations) P += equation.G.cols();
  System system{Eigen::MatrixXd::Zero(P, P), Eigen::VectorXd::Zero(P), {}};
  Eigen::Index next = lagging ? 1 : 0;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const ProjectedEquation& equation = equations[i];
    Share share;
    if (lagging) share.places.push_back(0);
    for (Eigen::Index j = 0; j < equation.G.cols(); ++j) share.places.push_back(next++);
    share.Z = lagging ? Beside(weights[i] * by_lag[i], Z[i]) : Z[i];
    system.A(share.places, share.places) +=
        share.Z.transpose() * (lagging ? Beside(by_lag[i], equation.G) : equation.G);
    system.c(share.places) += share.Z.transpose() * equation.b;
    system.shares.push_back(std::move(share));
  }
  return system;
}

/// A^-1 by way of unit diagonal scaling; nothing when A says nothing of some direction.
std::optional<Eigen::MatrixXd> Invert(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd rows = A.rowwise().norm();
  if (!A.allFinite() || (rows.array() <= 0.0).any()) return std::nullopt;
  const Eigen::VectorXd scale = rows.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = Scaled(A, scale);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-12).compute(scaled);
  if (decomposition.rank() < A.rows()) return std::nullopt;
  const Eigen::MatrixXd inverse = decomposition.pseudoInverse();
  return Scaled(inverse, scale);
}

/// By what the coefficients leave of each equation, half of it taken for white at least: all of it
/// only suits a boat that moves exactly as the model says. Where few windows are left for each
/// coefficient what they show of each other is believed less.
std::vector<ResidualWhitening> WhiteningsOf(const WeakProblem& problem,
                                            const ProjectedEquations& equations,
                                            const Thetas& thetas) {
  constexpr Eigen::Index kOrder = 10;
  constexpr double kWindowsPerCoefficient = 10.0;
  std::vector<ResidualWhitening> whitenings;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const auto& [index, columns, G, b] = equations[i];
    const auto runs = RunsOf(problem.supports[index].first_rows, problem.phi.stride);
    Eigen::VectorXd shown = DefiniteAutocovariance(runs, b - G * thetas[i], kResidualLags);
    const double few =
        kWindowsPerCoefficient * static_cast<double>(G.cols()) / static_cast<double>(G.rows());
    shown.tail(shown.size() - 1) /= 2.0 + few;
    whitenings.emplace_back(runs, shown.head(kOrder + 1));
  }
  return whitenings;
}

ProjectedEquations Whitened(const std::vector<ResidualWhitening>& whitenings,
                            const ProjectedEquations& equations) {
  ProjectedEquations white;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const auto& [index, columns, G, b] = equations[i];
    white.push_back({index, columns, whitenings[i].Whiten(G), whitenings[i].Whiten(b)});
  }
  return white;
}

std::vector<Eigen::MatrixXd> Whitened(const std::vector<ResidualWhitening>& whitenings,
                                      const std::vector<Eigen::MatrixXd>& sides) {
  std::vector<Eigen::MatrixXd> white;
  for (std::size_t i = 0; i < sides.size(); ++i) white.push_back(whitenings[i].Whiten(sides[i]));
  return white;
}

std::vector<Eigen::MatrixXd> OwnInstruments(const ProjectedEquations& equations) {
  std::vector<Eigen::MatrixXd> own;
  for (const ProjectedEquation& equation : equations) own.push_back(equation.G);
  return own;
}

void Unstack(const Eigen::VectorXd& stacked, Eigen::Index first, Thetas& thetas) {
  for (Eigen::VectorXd& theta : thetas) {
    theta = stacked.segment(first, theta.size());
    first += theta.size();
  }
}

std::vector<double> ResidualWeights(const ProjectedEquations& equations, const Thetas& thetas) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::VectorXd e = equations[i].b - equations[i].G * thetas[i];
    weights.push_back(static_cast<double>(e.size()) / std::max(e.squaredNorm(), 1e-300));
  }
  return weights;
}

double LeastSquaresMisfit(const ProjectedEquations& equations) {
  double misfit = 0.0;
  const Thetas thetas = SolveLeastSquares(equations);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Eigen::VectorXd e = equations[i].b - equations[i].G * thetas[i];
    misfit += std::log(std::max(e.squaredNorm(), 1e-300));
  }
  return misfit;
}

/// The lag from which Gauss-Newton starts: the best of a grid by least squares.
double StartingLag(const PreparedDataset& dataset, const WeakProblem& problem,
                   const std::array<std::vector<std::size_t>, 3>& columns) {
  double best = 0.1;
  double least = std::numeric_limits<double>::infinity();
  for (const double tau : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2}) {
    const double misfit = LeastSquaresMisfit(
        ProjectEquations(dataset, problem, FilterThrust(dataset, problem, tau), columns));
    if (misfit < least) {
      least = misfit;
      best = tau;
    }
  }
  return best;
}

/// Cov(Z'e) of residuals that are correlated alike all along, as they are on average.
Eigen::MatrixXd StationaryMeat(const WeakProblem& problem, std::size_t index,
                               const Eigen::VectorXd& residual, const Eigen::MatrixXd& Z) {
  const auto runs = RunsOf(problem.supports[index].first_rows, problem.phi.stride);
  return Z.transpose() * Correlate(runs, DefiniteAutocovariance(runs, residual, kResidualLags), Z);
}

WeakFit Write(const WeakProblem& problem, const ProjectedEquations& equations,
              const std::vector<ResidualWhitening>& whitenings, const System& system,
              const Eigen::MatrixXd& bread, const Thetas& thetas, const Thetas& regularised,
              const std::optional<double>& time_constant_s) {
  WeakFit fit;
  fit.problem = problem;
  fit.time_constant_s = time_constant_s;
  fit.bread = bread;
  fit.theta.resize(bread.rows());
  fit.scores = Eigen::MatrixXd::Zero(bread.rows(), static_cast<Eigen::Index>(problem.clusters));
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(bread.rows(), bread.rows());
  Eigen::Index next = 0;
  if (time_constant_s) fit.theta[next++] = *time_constant_s;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const ProjectedEquation& equation = equations[i];
    const auto& [places, Z] = system.shares[i];
    const Eigen::Index p = thetas[i].size();
    WeakEstimate estimate{equation.columns,
                          thetas[i],
                          regularised[i],
                          equation.G,
                          whitenings[i].WhitenBack(Z.rightCols(p)),
                          equation.b - equation.G * thetas[i]};
    const Eigen::VectorXd innovations = whitenings[i].Whiten(estimate.residual);
    fit.theta.segment(next, p) = thetas[i];
    next += p;
    const auto& clusters = problem.supports[equation.index].clusters;
    for (std::size_t s = 0; s < clusters.size(); ++s) {
      const auto begin = static_cast<Eigen::Index>(clusters[s].begin);
      const auto count = static_cast<Eigen::Index>(clusters[s].size());
      fit.scores(places, static_cast<Eigen::Index>(s)) +=
          Z.middleRows(begin, count).transpose() * innovations.segment(begin, count);
    }
    meat(places, places) += StationaryMeat(problem, equation.index, innovations, Z);
    fit.equations[equation.index] = std::move(estimate);
  }
  fit.stationary_covariance = Mapped(bread, meat);
  return fit;
}

/// Whether each recording has a window.
std::vector<bool> RecordingsCovered(const PreparedDataset& dataset,
                                    const TestFunctionSupports& supports) {
  std::vector<bool> covered(dataset.Recordings(), false);
  std::size_t segment = 0;
  for (const std::size_t first : supports.first_rows) {
    while (first >= dataset.segments[segment].end) ++segment;
    covered[dataset.RecordingOf(segment)] = true;
  }
  return covered;
}

/// Of the columns of G in the order of the stacked unknowns; a time constant moves nothing by
/// itself.
Eigen::VectorXd StackedSizes(const WeakFit& fit) {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(fit.theta.size());
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto [begin, size] = fit.BlockOf(j);
    sizes.segment(begin, size) = Norms(fit.equations[j]->G);
  }
  return sizes;
}

/// How prior forces of mean square 1 / weight draw an estimate: off it goes gain times its forces.
Eigen::MatrixXd Gain(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& sizes,
                     double weight) {
  Eigen::MatrixXd normal = weight * Scaled(covariance, sizes);
  normal.diagonal().array() += 1.0;
  const Eigen::MatrixXd moved = sizes.asDiagonal() * covariance;
  return weight * normal.ldlt().solve(moved).transpose();
}

}  // namespace

std::optional<WeakFit> EstimateWeakIv(const PreparedDataset& dataset,
                                      const RegressionOptions& regression,
                                      const std::array<std::vector<std::size_t>, 3>& columns,
                                      const WeakIvOptions& options) {
  const WeakProblem problem = BuildWeakForm(dataset, regression, options.form);
  const bool lagging = regression.structure == Structure::kFirstOrderDynamic;
  std::optional<double> tau;
  if (lagging) tau = StartingLag(dataset, problem, columns);
  FilteredThrust thrust = FilterThrust(dataset, problem, tau);
  ProjectedEquations equations = ProjectEquations(dataset, problem, thrust, columns);
  Require(!equations.empty(), "at least one equation with coefficients to seek");
  for (const ProjectedEquation& equation : equations) {
    if (equation.G.rows() <= equation.G.cols()) return std::nullopt;
  }
  const Instruments instruments(dataset, problem);
  Thetas regularised = Regularised(equations, OwnInstruments(equations), options.ridge);
  Thetas thetas = regularised;
  const int rounds = lagging ? 2 * options.iterations : options.iterations;
  for (int round = 1;; ++round) {
    const auto predicted = instruments.Predict(
        ModelWith(problem, equations, regularised),
        ConstantDisturbancesWith(problem, equations, regularised), columns, thrust);
    ProjectedEquations completed = Completed(equations, predicted);
    std::vector<Eigen::MatrixXd> by_lag;
    if (lagging) by_lag = ThrustByLag(dataset, problem, equations, thetas, *tau);
    const auto whitenings = WhiteningsOf(problem, completed, thetas);
    const ProjectedEquations white = Whitened(whitenings, completed);
    const auto white_Z = Whitened(whitenings, InstrumentsOf(equations, predicted));
    const System system =
        Stack(white, white_Z, Whitened(whitenings, by_lag), ResidualWeights(white, thetas));
    const auto bread = Invert(system.A);
    if (!bread) return std::nullopt;
    const Eigen::VectorXd solution = *bread * system.c;
    if (lagging) {
      const double change = std::clamp(solution[0], -0.5 * *tau, *tau);
      tau = std::clamp(*tau + change, kShortestTimeConstantS, kLongestTimeConstantS);
      thrust = FilterThrust(dataset, problem, tau);
    }
    Unstack(solution, lagging ? 1 : 0, thetas);
    regularised = Regularised(white, white_Z, options.ridge);
    if (lagging) {
      equations = ProjectEquations(dataset, problem, thrust, columns);
      completed = Completed(equations, predicted);
    }
    if (round == rounds) {
      return Write(problem, completed, whitenings, system, *bread, thetas, regularised, tau);
    }
  }
}

std::array<std::vector<std::size_t>, 3> AllColumns(Parameterization parameterization) {
  std::array<std::vector<std::size_t>, 3> columns;
  for (const Equation equation : kEquations) {
    auto& of_this = columns[IndexOf(equation)];
    of_this.resize(Regressors(equation, parameterization).size());
    std::iota(of_this.begin(), of_this.end(), std::size_t{0});
  }
  return columns;
}

Block WeakFit::BlockOf(std::size_t equation) const {
  Block block{time_constant_s ? 1 : 0, equations[equation]->theta.size()};
  for (std::size_t j = 0; j < equation; ++j) {
    if (equations[j]) block.begin += equations[j]->theta.size();
  }
  return block;
}

std::vector<Block> WeakFit::Blocks() const {
  std::vector<Block> blocks;
  if (time_constant_s) blocks.push_back({0, 1});
  for (std::size_t j = 0; j < equations.size(); ++j) {
    if (equations[j]) blocks.push_back(BlockOf(j));
  }
  return blocks;
}

Eigen::VectorXd WeakFit::Regularised() const {
  Eigen::VectorXd stacked = theta;
  for (std::size_t j = 0; j < equations.size(); ++j) {
    if (!equations[j]) continue;
    const auto [begin, size] = BlockOf(j);
    stacked.segment(begin, size) = equations[j]->regularised;
  }
  return stacked;
}

RidgePosterior RidgePosteriorOf(const WeakFit& fit, double prior_scale) {
  const Eigen::MatrixXd covariance = ClusterCovariance(fit);
  const Eigen::VectorXd sizes = StackedSizes(fit);
  const Eigen::VectorXd forces = sizes.cwiseProduct(fit.theta);
  const auto P = static_cast<double>(fit.theta.size());
  const double mean_square = covariance.diagonal().dot(sizes.cwiseAbs2()) / P;
  const auto distance = [&](const Eigen::MatrixXd& gain, double weight) {
    const Eigen::VectorXd off = gain * forces;
    // Cov^-1 off = weight sizes (forces - sizes off)
    return weight * off.cwiseProduct(sizes).dot(forces - sizes.cwiseProduct(off)) / P;
  };
  double lightest = -12.0;
  double heaviest = 12.0;
  Eigen::MatrixXd gain;
  for (int halving = 0; halving < 40; ++halving) {
    const double posterior_mean = 0.5 * (lightest + heaviest);
    const double weight = std::pow(10.0, posterior_mean) / mean_square;
    gain = Gain(covariance, sizes, weight);
    (distance(gain, weight) > prior_scale ? heaviest : lightest) = posterior_mean;
  }
  return {fit.theta - gain * forces, covariance - gain * sizes.asDiagonal() * covariance};
}

VesselModel ModelOf(const WeakFit& fit, const Eigen::VectorXd& theta, double sampling_period_s) {
  VesselModel model = VesselModel::OfZeros(
      fit.time_constant_s ? Structure::kFirstOrderDynamic : Structure::kStaticQuadratic,
      fit.problem.parameterization, Discretisation::kContinuous, sampling_period_s);
  model.dead_zone = fit.problem.dead_zone;
  Eigen::Index next = 0;
  if (fit.time_constant_s) {
    model.thruster_time_constant_s = std::max(theta[next++], kShortestTimeConstantS);
  }
  for (const Equation equation : kEquations) {
    const std::size_t j = IndexOf(equation);
    if (!fit.equations[j]) continue;
    for (const std::size_t column : fit.equations[j]->columns) {
      const auto place = static_cast<Eigen::Index>(column);
      if (place < model.theta[j].size()) model.theta[j][place] = theta[next];
      ++next;
    }
  }
  return model;
}

std::array<std::vector<std::size_t>, 3> WithRecordingBiasTerms(
    const PreparedDataset& dataset, const WeakProblem& problem,
    const std::array<std::vector<std::size_t>, 3>& columns,
    const std::vector<bool>& heading_varies) {
  auto all = columns;
  const std::size_t each = problem.disturbance_terms.PerRecording();
  if (each == 0) return all;
  for (std::size_t j = 0; j < 3; ++j) {
    if (all[j].empty()) continue;
    const auto regressors = Regressors(kEquations[j], problem.parameterization);
    std::erase_if(all[j], [&](std::size_t column) { return regressors[column].name == "1"; });
    const std::vector<bool> covered = RecordingsCovered(dataset, problem.supports[j]);
    for (std::size_t recording = 0; recording < covered.size(); ++recording) {
      if (!covered[recording]) continue;
      const std::size_t terms = heading_varies[recording] ? each : 1;
      for (std::size_t term = 0; term < terms; ++term) {
        all[j].push_back(regressors.size() + recording * each + term);
      }
    }
  }
  return all;
}

std::vector<ConstantDisturbance> ConstantDisturbancesOf(const WeakFit& fit,
                                                        const Eigen::VectorXd& theta) {
  std::vector<ConstantDisturbance> disturbance_terms(fit.problem.disturbance_terms.recordings);
  for (std::size_t j = 0; j < fit.equations.size(); ++j) {
    if (!fit.equations[j]) continue;
    const auto [begin, size] = fit.BlockOf(j);
    AddConstantDisturbance(fit.problem, j, fit.equations[j]->columns, theta.segment(begin, size),
                           disturbance_terms);
  }
  return disturbance_terms;
}

bool LagIsAtLowerBound(const WeakFit& fit) {
  return fit.time_constant_s && *fit.time_constant_s < 1.5 * kShortestTimeConstantS;
}

Eigen::MatrixXd ClusterCovariance(const WeakFit& fit) {
  const auto g = static_cast<double>(fit.scores.cols());
  const auto p = static_cast<double>(fit.theta.size());
  Require(g > 1.0, "at least two clusters");
  const Eigen::MatrixXd influence = fit.bread * fit.scores;
  const Eigen::MatrixXd clustered = g / (g - 1.0) * OfRoot(influence);
  const double scale =
      clustered.diagonal().cwiseQuotient(fit.stationary_covariance.diagonal()).mean();
  return g / (p + g) * clustered + p / (p + g) * scale * fit.stationary_covariance;
}

}  // namespace telltale
