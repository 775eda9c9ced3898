#include "telltale/core/diagnosis/testability.hpp"

#include <cmath>
#include <string>

#include "telltale/core/diagnosis/shaking.hpp"

namespace telltale {
namespace {

constexpr double kShows = 3.0;  // sigmas

std::string NameOf(const UncertainModel& model, Eigen::Index i) {
  const auto& [equation, column] = model.free[static_cast<std::size_t>(i)];
  const auto regressors = Regressors(equation, model.model.parameterization);
  return std::string(Name(equation)) + ' ' +
         std::string(regressors[static_cast<std::size_t>(column)].name);
}

/// The coefficient whose change looks most like the effect.
std::string Absorber(const Evidence& evidence, const UncertainModel& model,
                     const Eigen::VectorXd& seen) {
  const Eigen::MatrixXd base = evidence.judge.SeeColumns(evidence.recording.by_base);
  Eigen::Index most = 0;
  (base.transpose() * seen)
      .cwiseQuotient(base.colwise().norm().transpose().cwiseMax(1e-12))
      .cwiseAbs()
      .maxCoeff(&most);
  return NameOf(model, most);
}

}  // namespace

std::vector<EffectTestability> TestabilityOf(const Evidence& evidence, const UncertainModel& model,
                                             std::span<const Effect* const> library) {
  std::vector<EffectTestability> all;
  for (const Effect* effect : library) {
    EffectTestability& one = all.emplace_back();
    one.effect = effect->Name();
    double alone = 0.0;
    double counted = 0.0;
    for (std::size_t j = 0; j < evidence.slots.size(); ++j) {
      if (evidence.slots[j].effect != effect) continue;
      const Eigen::VectorXd seen =
          evidence.judge.SeeColumns(evidence.recording.by_slot.col(static_cast<Eigen::Index>(j)))
              .col(0);
      const double sigmas = evidence.judge.Sigmas(seen);
      alone += seen.squaredNorm() / evidence.judge.RowsALook();
      one.detectability += sigmas * sigmas;
      counted += 1.0;
      if (one.absorbed_by.empty()) one.absorbed_by = Absorber(evidence, model, seen);
    }
    if (counted == 0.0) {
      one.detectability = ShakingDetectability(*effect, evidence);
      alone = one.detectability;
    } else {
      one.detectability = std::sqrt(one.detectability / counted);
      alone = std::sqrt(alone / counted);
    }
    one.testability = one.detectability >= kShows ? Testability::kTestable
                      : alone >= kShows           ? Testability::kAbsorbed
                                                  : Testability::kNotExcited;
    if (one.testability != Testability::kAbsorbed) one.absorbed_by.clear();
  }
  return all;
}

}  // namespace telltale
