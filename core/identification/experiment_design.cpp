#include "telltale/core/identification/experiment_design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telltale/core/base/format_number.hpp"
#include "telltale/core/base/linear_algebra/covariance.hpp"
#include "telltale/core/base/linear_algebra/eigen_decompositions.hpp"
#include "telltale/core/base/median.hpp"
#include "telltale/core/identification/shrinkage.hpp"
#include "telltale/core/simulation/divergence.hpp"
#include "telltale/core/simulation/free_run.hpp"
#include "telltale/core/simulation/manoeuvre_catalogue.hpp"
#include "telltale/core/simulation/manoeuvres.hpp"
#include "telltale/core/simulation/simulator.hpp"

namespace telltale {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kWideShare = 0.25;     // of the estimate,
constexpr double kMaterialShare = 0.1;  // and of the accelerations that manoeuvres make
// A manoeuvre is named for an interval that it shrinks to this share or less.
constexpr double kLargestShrinkRatio = 0.8;

/// Phi'Phi of all regressors from the triangle of the excited ones; zero for the others.
Eigen::MatrixXd GramOf(const Excitation& excitation, std::size_t regressors) {
  const auto p = static_cast<Eigen::Index>(regressors);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(p, p);
  const Eigen::MatrixXd triangle = excitation.factor.R * excitation.column_norms.asDiagonal();
  gram(excitation.excited, excitation.excited) = triangle.transpose() * triangle;
  return gram;
}

/// The diagonal of information^-1, infinite along what it does not determine. Independent of units.
Eigen::VectorXd Variances(const Eigen::MatrixXd& information) {
  constexpr double kUndetermined = 1e-12;
  const Eigen::VectorXd units = information.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = units.unaryExpr([](double u) { return u > 0.0 ? 1.0 / u : 0.0; });
  const Eigen::MatrixXd scaled = Scaled(information, inverse);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const double largest = eigen.eigenvalues().maxCoeff();
  Eigen::VectorXd variances = Eigen::VectorXd::Zero(units.size());
  for (Eigen::Index k = 0; k < units.size(); ++k) {
    const double value = eigen.eigenvalues()[k];
    const Eigen::VectorXd shares = eigen.eigenvectors().col(k).cwiseAbs2();
    for (Eigen::Index j = 0; j < units.size(); ++j) {
      if (value > kUndetermined * largest) {
        variances[j] += shares[j] / value;
      } else if (shares[j] > kUndeterminedShare) {
        variances[j] = kInfinity;
      }
    }
  }
  return variances.cwiseProduct(inverse.cwiseAbs2()).unaryExpr([](double v) {
    return std::isnan(v) ? kInfinity : v;
  });
}

/// ln det of the block of information^-1 that belongs to `chosen`.
double LogVolume(const Eigen::MatrixXd& information, const std::vector<Eigen::Index>& chosen) {
  const Eigen::VectorXd inverse = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = Scaled(information, inverse);
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols());
  const Eigen::MatrixXd covariance = scaled.ldlt().solve(unit);
  const Eigen::VectorXd pivots =
      Eigen::MatrixXd(covariance(chosen, chosen)).ldlt().vectorD().cwiseMax(1e-300);
  return pivots.array().log().sum() + 2.0 * inverse(chosen).array().log().sum();
}

double HalfWidth(const Interval& interval) {
  return 0.5 * (interval.upper - interval.lower);
}

/// How many standard errors half an interval is wide.
double WidthFactor(const Identification& identification) {
  constexpr double kNormal = 1.96;
  std::vector<double> factors;
  for (const Coefficient& c : identification.coefficients) {
    const double factor = HalfWidth(c.interval) / c.standard_error;
    if (std::isfinite(factor)) factors.push_back(factor);
  }
  return factors.empty() ? kNormal : Median(std::move(factors));
}

/// The mirrored partner of a thrust coefficient: reverse thrust for forward.
std::string MirrorOf(const std::string& regressor) {
  return regressor.starts_with("r:") ? 'f' + regressor.substr(1) : "";
}

/// Reverse thrust that the data do not excite is set to mirrored forward thrust: T(-d) = -T(d).
void AssumeReverseThrust(const Identification& identification, VesselModel& model) {
  for (const Equation equation : kEquations) {
    const auto regressors = Regressors(equation, model.parameterization);
    Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    for (const Coefficient& c : identification.coefficients) {
      if (c.equation != equation || c.status != CoefficientStatus::kNotExcited) continue;
      const auto place = [&](const std::string& name) {
        return std::find_if(regressors.begin(), regressors.end(),
                            [&](const Regressor& r) { return r.name == name; }) -
               regressors.begin();
      };
      if (MirrorOf(c.regressor).empty()) continue;
      const double sign = c.regressor.ends_with("^2") ? -1.0 : 1.0;
      theta[place(c.regressor)] = sign * theta[place(MirrorOf(c.regressor))];
    }
  }
}

/// Two significant digits, and never a power of ten for numbers people read at a glance.
std::string TwoDigits(double value) {
  return value >= 100.0 && value < 1e6 ? FormatNumber(value, 0) : FormatSignificant(value, 2);
}

/// In per cent of the estimate where that makes sense.
std::string InWords(const ExpectedBounds& expected) {
  const std::string name = std::string(Name(expected.equation)) + ' ' + expected.regressor;
  const double size = std::abs(expected.estimate);
  const bool relative = expected.expected_half_width < size;
  const auto width = [&](double half_width) {
    return relative
               ? "±" + TwoDigits(100.0 * half_width / size) + " %"
               : "±" + TwoDigits(half_width) + (expected.unit == "1" ? "" : ' ' + expected.unit);
  };
  if (std::isinf(expected.half_width)) {
    const std::string now = "±" + TwoDigits(expected.expected_half_width) +
                            (expected.unit == "1" ? "" : ' ' + expected.unit);
    return name + " from unknown to " + now;
  }
  return name + " from " + width(expected.half_width) + " to " +
         width(expected.expected_half_width);
}

/// Infinite widths that become finite count most. To a millionth, so that rounding never decides
/// which of two that shrink alike is named first.
double Shrink(const ExpectedBounds& expected) {
  if (std::isinf(expected.expected_half_width)) return 1.0;
  if (std::isinf(expected.half_width)) return 0.0;
  return std::round(1e6 * expected.expected_half_width / expected.half_width) / 1e6;
}

}  // namespace

ManoeuvreAdvisor::ManoeuvreAdvisor(const Identification& identification, AdviceBasis basis)
    : identification_(identification), basis_(std::move(basis)) {
  for (const Equation equation : kEquations) {
    if (!identification.Has(equation) || !basis_.excitations[IndexOf(equation)]) return;
  }
  for (std::size_t j = 0; j < equation_information_.size(); ++j) AssessInformation(j);
  for (const double prior_scale : kRelativePriorScales) {
    VesselModel model = RegularisedModel(identification, prior_scale);
    AssumeReverseThrust(identification, model);
    if (SimulateCatalogue(model)) return;
  }
}

void ManoeuvreAdvisor::AssessInformation(std::size_t equation) {
  const Excitation& excitation = *basis_.excitations[equation];
  const auto& coefficients = identification_.coefficients;
  const auto begin = std::find_if(coefficients.begin(), coefficients.end(),
                                  [&](const auto& c) { return c.equation == excitation.equation; });
  const std::size_t p = Regressors(excitation.equation, identification_.parameterization).size();
  EquationInformation equation_information;
  equation_information.first = static_cast<std::size_t>(begin - coefficients.begin());
  equation_information.gram = GramOf(excitation, p);
  equation_information.scale = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(p), kInfinity);
  equation_information.prior.resize(static_cast<Eigen::Index>(p));
  const Eigen::VectorXd variances = Variances(equation_information.gram);
  std::vector<double> scales;
  double largest_thrust = 0.0;
  for (std::size_t j = 0; j < p; ++j) {
    const auto place = static_cast<Eigen::Index>(j);
    const Coefficient& c = *(begin + static_cast<std::ptrdiff_t>(j));
    const double scale = c.standard_error / std::sqrt(variances[place]);
    if (std::isfinite(scale) && scale > 0.0) {
      equation_information.scale[place] = scale;
      scales.push_back(scale);
    }
    equation_information.prior[place] = std::abs(c.estimate);
    const auto regressors = Regressors(c.equation, identification_.parameterization);
    if (regressors[j].is_propeller) {
      largest_thrust = std::max(largest_thrust, std::abs(c.estimate));
    }
  }
  if (scales.empty() || largest_thrust <= 0.0) return;
  // An unknown coefficient is assumed to have the median noise scale of the others.
  const double usual = Median(std::move(scales));
  for (Eigen::Index j = 0; j < equation_information.scale.size(); ++j) {
    if (std::isinf(equation_information.scale[j])) equation_information.scale[j] = usual;
    if (equation_information.prior[j] <= 0.0) equation_information.prior[j] = largest_thrust;
  }
  equation_information_[equation] = std::move(equation_information);
}

bool ManoeuvreAdvisor::SimulateCatalogue(const VesselModel& model) {
  simulated_.clear();
  const std::size_t count = ManoeuvreCatalogue().size();
  for (std::size_t i = 0; i < count; ++i) {
    if (auto simulated = SimulateManoeuvre(model, i)) simulated_.push_back(*std::move(simulated));
  }
  return 2 * simulated_.size() > count;
}

std::optional<ManoeuvreAdvisor::SimulatedManoeuvre> ManoeuvreAdvisor::SimulateManoeuvre(
    const VesselModel& model, std::size_t manoeuvre) const {
  constexpr double kLongestStepS = 0.1;
  const double h = identification_.sampling_period_s;
  const auto steps_a_row = static_cast<std::size_t>(std::ceil(h / kLongestStepS - 1e-9));
  const std::vector<TimedCommand> commands =
      Schedule({ManoeuvreCatalogue()[manoeuvre].manoeuvre}, 0.0);
  const std::vector<TimedState> track =
      Simulate(model, {}, commands, kCatalogueDurationS, h / static_cast<double>(steps_a_row));
  const Nu limits = kFreeRunDivergence.LimitsFor(basis_.fastest);
  SimulatedManoeuvre simulated{manoeuvre, {}, {}};
  for (const Equation equation : kEquations) {
    const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
    simulated.gram[IndexOf(equation)] = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  }
  std::vector<double> row;
  for (std::size_t k = 0; k < track.size(); ++k) {
    const TimedState& now = track[k];
    if (!Within(now.state.nu, limits)) return std::nullopt;
    if (k % steps_a_row != 0) continue;
    for (const Equation equation : kEquations) {
      if (!Enters(RegionOf(now.delta), equation, basis_.regression)) continue;
      const Eigen::VectorXd& theta = model.theta[IndexOf(equation)];
      row.resize(static_cast<std::size_t>(theta.size()));
      FillRow(equation, model.parameterization, now.state.nu, model.dead_zone.Apply(now.delta),
              row);
      const Eigen::Map<const Eigen::VectorXd> phi(row.data(), theta.size());
      simulated.gram[IndexOf(equation)].noalias() += phi * phi.transpose();
      simulated.squares[IndexOf(equation)] += std::pow(phi.dot(theta), 2);
    }
  }
  return simulated;
}

bool ManoeuvreAdvisor::IsWide(std::size_t coefficient, const Eigen::MatrixXd& gram,
                              double squares) const {
  const Coefficient& c = identification_.coefficients[coefficient];
  const EquationInformation& equation_information = *equation_information_[IndexOf(c.equation)];
  const auto place = static_cast<Eigen::Index>(coefficient - equation_information.first);
  const double half_width = HalfWidth(c.interval);
  return half_width > kWideShare * std::abs(c.estimate) &&
         half_width * std::sqrt(gram(place, place)) > kMaterialShare * std::sqrt(squares);
}

OpenCoefficients ManoeuvreAdvisor::Open() const {
  OpenCoefficients open;
  if (simulated_.empty()) return open;
  SimulatedManoeuvre all = simulated_.front();
  for (std::size_t i = 1; i < simulated_.size(); ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      all.gram[j] += simulated_[i].gram[j];
      all.squares[j] += simulated_[i].squares[j];
    }
  }
  for (std::size_t i = 0; i < identification_.coefficients.size(); ++i) {
    const Coefficient& c = identification_.coefficients[i];
    const std::size_t j = IndexOf(c.equation);
    if (!equation_information_[j]) continue;
    if (c.status != CoefficientStatus::kEstimated || IsWide(i, all.gram[j], all.squares[j])) {
      open.push_back(i);
    }
  }
  return open;
}

ManoeuvreAdvice ManoeuvreAdvisor::Expect(const SimulatedManoeuvre& simulated,
                                         const OpenCoefficients& open) const {
  const CatalogueManoeuvre& manoeuvre = ManoeuvreCatalogue()[simulated.manoeuvre];
  ManoeuvreAdvice advice{
      std::string(manoeuvre.name), std::string(manoeuvre.how), kCatalogueDurationS, 0.0, {}};
  const double factor = WidthFactor(identification_);
  for (std::size_t j = 0; j < equation_information_.size(); ++j) {
    if (!equation_information_[j]) continue;
    const EquationInformation& equation_information = *equation_information_[j];
    const Eigen::MatrixXd after = equation_information.gram + simulated.gram[j];
    const Eigen::VectorXd before_variances = Variances(equation_information.gram);
    const Eigen::VectorXd variances = Variances(after);
    std::vector<Eigen::Index> chosen;
    for (const std::size_t i : open) {
      const Coefficient& c = identification_.coefficients[i];
      if (IndexOf(c.equation) != j) continue;
      const auto place = static_cast<Eigen::Index>(i - equation_information.first);
      chosen.push_back(place);
      const double now = HalfWidth(c.interval);
      const double ratio = std::sqrt(variances[place] / before_variances[place]);
      const double expected =
          std::isfinite(now) && std::isfinite(ratio)
              ? now * ratio
              : factor * equation_information.scale[place] * std::sqrt(variances[place]);
      advice.expected.push_back({c.equation, c.regressor, c.unit, c.estimate, now, expected});
    }
    if (chosen.empty()) continue;
    const Eigen::VectorXd prior_information =
        equation_information.scale.cwiseQuotient(equation_information.prior).cwiseAbs2();
    const auto with_prior = [&](Eigen::MatrixXd information) {
      information.diagonal() += prior_information;
      return information;
    };
    advice.expected_nats += 0.5 * (LogVolume(with_prior(equation_information.gram), chosen) -
                                   LogVolume(with_prior(after), chosen));
  }
  std::stable_sort(advice.expected.begin(), advice.expected.end(),
                   [](const auto& a, const auto& b) { return Shrink(a) < Shrink(b); });
  return advice;
}

std::vector<ManoeuvreAdvice> ManoeuvreAdvisor::AdviseManoeuvres(
    const OpenCoefficients& open) const {
  std::vector<ManoeuvreAdvice> advice;
  if (open.empty()) return advice;
  for (const SimulatedManoeuvre& simulated : simulated_) {
    ManoeuvreAdvice expected = Expect(simulated, open);
    const bool is_informative = std::any_of(
        expected.expected.begin(), expected.expected.end(),
        [](const ExpectedBounds& bounds) { return Shrink(bounds) <= kLargestShrinkRatio; });
    if (is_informative) advice.push_back(std::move(expected));
  }
  std::stable_sort(advice.begin(), advice.end(),
                   [](const auto& a, const auto& b) { return a.expected_nats > b.expected_nats; });
  return advice;
}

std::string InWords(const ManoeuvreAdvice& advice, std::size_t most) {
  std::string words;
  std::size_t named = 0;
  std::size_t more = 0;
  for (const ExpectedBounds& expected : advice.expected) {
    if (Shrink(expected) > kLargestShrinkRatio) continue;
    if (named == most) {
      ++more;
      continue;
    }
    words += (named++ == 0 ? " would shrink " : ", ") + InWords(expected);
  }
  if (words.empty()) return "";
  if (more > 0) words += " and " + std::to_string(more) + " more";
  return advice.manoeuvre + " for " + TwoDigits(advice.duration_s) + " s" + words;
}

void AdviseManoeuvres(AdviceBasis basis, Identification& identification) {
  const std::array<std::optional<Excitation>, 3> excitations = basis.excitations;
  const ManoeuvreAdvisor advisor(identification, std::move(basis));
  identification.advice = advisor.AdviseManoeuvres(advisor.Open());
  for (const auto& excitation : excitations) {
    if (!excitation) continue;
    EquationProblem names;
    names.equation = excitation->equation;
    names.regressors = Regressors(excitation->equation, identification.parameterization);
    for (const CollinearGroup& group : excitation->collinear) {
      const std::string subject = Explain(group, names).subject;
      OpenCoefficients together;
      for (const std::size_t column : group.columns) {
        for (std::size_t i = 0; i < identification.coefficients.size(); ++i) {
          const Coefficient& c = identification.coefficients[i];
          if (c.equation == names.equation && c.regressor == names.regressors[column].name) {
            together.push_back(i);
          }
        }
      }
      const auto advice = advisor.AdviseManoeuvres(together);
      const std::string words = advice.empty() ? "" : InWords(advice.front());
      if (words.empty()) continue;
      for (Refusal& refusal : identification.refusals) {
        if (refusal.subject == subject) refusal.advice = words;
      }
    }
  }
}

}  // namespace telltale
