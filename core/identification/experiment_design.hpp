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

/// The data behind the advice, all of one identification.
struct AdviceBasis {
  std::array<std::optional<Excitation>, 3> excitations;
  RegressionOptions regression;
  Nu fastest;  ///< largest absolute velocities in the data; a simulation far beyond them has
               ///< diverged
};

/// Coefficients that one piece of advice is about: positions in Identification::coefficients.
using OpenCoefficients = std::vector<std::size_t>;

/// Experiment design: the manoeuvres that narrow ill-determined coefficients most. Each manoeuvre
/// of the catalogue is simulated with the identified model, regularised where the data determine
/// little, and its rows are added to those of the data; docs/concepts/model.md (65), (66).
/// D-optimal within the catalogue: sorted by the information about the open coefficients together.
/// A manoeuvre is left out when its simulation diverges or when it leaves four fifths of every
/// interval.
class ManoeuvreAdvisor {
 public:
  ManoeuvreAdvisor(const Identification& identification, AdviceBasis basis);

  /// Not excited, collinear, or wide: the interval reaches further than a quarter of the estimate
  /// and amounts to more than a tenth of the accelerations in the catalogue's manoeuvres.
  OpenCoefficients Open() const;

  /// Best first; empty where nothing is open or no boat can be simulated.
  std::vector<ManoeuvreAdvice> AdviseManoeuvres(const OpenCoefficients& open) const;

 private:
  struct EquationInformation {
    std::size_t first = 0;  ///< of its coefficients among all
    Eigen::MatrixXd gram;   ///< of the regressors in the data
    Eigen::VectorXd scale;  ///< standard errors are scale sqrt(diag(gram^-1))
    Eigen::VectorXd prior;  ///< prior scale of the coefficients
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

/// "zigzag for 120 s would shrink YAW r|r| from ±40 % to ±8 %", of at most `most` coefficients;
/// empty where it would do nothing of note.
std::string InWords(const ManoeuvreAdvice& advice, std::size_t most = 3);

/// Writes advice into an identification, and into those of its refusals that are about collinear
/// coefficients.
void AdviseManoeuvres(AdviceBasis basis, Identification& identification);

}  // namespace telltale
