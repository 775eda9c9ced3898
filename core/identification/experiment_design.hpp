#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "telltale/core/estimation/regression/excitation.hpp"
#include "telltale/core/estimation/regression/regression_problem.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/vessel/motion.hpp"

namespace telltale {

/// What advice is worked out from, all of one identification.
struct AdviceBasis {
  std::array<std::optional<Excitation>, 3> excitations;
  RegressionOptions regression;
  Nu fastest;  ///< largest absolute velocities in the data; a boat far beyond them has run away
};

/// Coefficients that one piece of advice is about: positions in Identification::coefficients.
using OpenCoefficients = std::vector<std::size_t>;

/// Which manoeuvre next? Every manoeuvre of the catalogue is simulated with the identified boat,
/// tamed where the data say little, and its rows are added to those there are;
/// docs/concepts/model.md (65), (66). D-optimal among the catalogue: sorted by what they tell of
/// the open coefficients together. Manoeuvres in which the simulated boat runs away, or that would
/// leave four fifths of every interval, are left out.
class ManoeuvreAdvisor {
 public:
  ManoeuvreAdvisor(const Identification& identification, AdviceBasis basis);

  /// Not excited, collinear, or wide: the interval reaches further than a quarter of the estimate
  /// and is worth more than a tenth of the accelerations that the catalogue's manoeuvres make.
  OpenCoefficients Open() const;

  /// Best first; empty where nothing is open or no boat can be simulated.
  std::vector<ManoeuvreAdvice> AdviseManoeuvres(const OpenCoefficients& open) const;

 private:
  struct EquationInformation {
    std::size_t first = 0;  ///< of its coefficients among all
    Eigen::MatrixXd gram;   ///< of the regressors in the data
    Eigen::VectorXd scale;  ///< standard errors are scale sqrt(diag(gram^-1))
    Eigen::VectorXd prior;  ///< how large coefficients are believed to be before any data
  };
  struct SimulatedManoeuvre {
    std::size_t manoeuvre = 0;            ///< in the catalogue
    std::array<Eigen::MatrixXd, 3> gram;  ///< of the regressors it would give
    std::array<double, 3> squares{};      ///< of the accelerations it makes
  };

  void AssessInformation(std::size_t equation);
  bool SimulateCatalogue(const VesselModel& model);
  std::optional<SimulatedManoeuvre> SimulateManoeuvre(const VesselModel& model,
                                                      std::size_t manoeuvre) const;
  ManoeuvreAdvice Expect(const SimulatedManoeuvre& simulated, const OpenCoefficients& open) const;
  bool IsWide(std::size_t coefficient, const Eigen::MatrixXd& gram, double squares) const;

  const Identification& identification_;
  AdviceBasis basis_;
  std::array<std::optional<EquationInformation>, 3> equation_information_;
  std::vector<SimulatedManoeuvre> simulated_;
};

/// "zigzag for 120 s would shrink YAW r|r| from +-40 % to +-8 %", of at most `most` coefficients;
/// empty where it would do nothing of note.
std::string InWords(const ManoeuvreAdvice& advice, std::size_t most = 3);

/// Writes advice into an identification, and into those of its refusals that are about collinear
/// coefficients.
void AdviseManoeuvres(AdviceBasis basis, Identification& identification);

}  // namespace telltale
