#include "telltale/core/vessel/regressors.hpp"

#include <algorithm>

#include "telltale/core/base/contract.hpp"

namespace telltale {
namespace {

// Body terms follow the paper's sigma_j (its equation for the lumped disturbance), propeller terms
// its F_u and tau_r. W stands for M^-1, so that W11 = M^-1(1,1); in sway and yaw the propeller
// symbols carry the lever arm d/2. docs/reference/notation.md lists every symbol.
constexpr std::array kSurgeBody = {
    Regressor{"u|u|", "Pu11", "1/m"}, Regressor{"vr", "2Qu23", "1"}, Regressor{"rr", "Qu33", "m"},
    Regressor{"u", "Ru1", "1/s"},     Regressor{"1", "cu", "m/s^2"},
};
constexpr std::array kSwayBody = {
    Regressor{"v|v|", "Pv22", "1/m"}, Regressor{"v|r|", "Pv23", "1"},
    Regressor{"r|v|", "Pv32", "1"},   Regressor{"r|r|", "Pv33", "m"},
    Regressor{"uv", "2Qv12", "1/m"},  Regressor{"ur", "2Qv13", "1"},
    Regressor{"v", "Rv2", "1/s"},     Regressor{"r", "Rv3", "m/s"},
    Regressor{"1", "cv", "m/s^2"},
};
constexpr std::array kYawBody = {
    Regressor{"v|v|", "Pr22", "1/m^2"}, Regressor{"v|r|", "Pr23", "1/m"},
    Regressor{"r|v|", "Pr32", "1/m"},   Regressor{"r|r|", "Pr33", "1"},
    Regressor{"uv", "2Qr12", "1/m^2"},  Regressor{"ur", "2Qr13", "1/m"},
    Regressor{"v", "Rr2", "1/(m s)"},   Regressor{"r", "Rr3", "1/s"},
    Regressor{"1", "cr", "1/s^2"},
};

constexpr Regressor Thrust(std::string_view name, std::string_view symbol, std::string_view unit) {
  return {name, symbol, unit, true};
}

constexpr std::array kSurgePropeller = {
    Thrust("f:d^2", "W11af", "m/s^2"), Thrust("f:d", "W11bf", "m/s^2"),
    Thrust("r:d^2", "W11ar", "m/s^2"), Thrust("r:d", "W11br", "m/s^2")};
constexpr std::array kSwayPropeller = {
    Thrust("f:d^2", "W23af", "m/s^2"), Thrust("f:d", "W23bf", "m/s^2"),
    Thrust("r:d^2", "W23ar", "m/s^2"), Thrust("r:d", "W23br", "m/s^2")};
constexpr std::array kYawPropeller = {
    Thrust("f:d^2", "W33af", "1/s^2"), Thrust("f:d", "W33bf", "1/s^2"),
    Thrust("r:d^2", "W33ar", "1/s^2"), Thrust("r:d", "W33br", "1/s^2")};

constexpr std::array kSurgePaper = {Thrust("mean^2+diff^2/4", "2W11af", "m/s^2"),
                                    Thrust("mean", "2W11bf", "m/s^2")};
constexpr std::array kSwayPaper = {
    Thrust("mean^2+diff^2/4", "W23(aL-aR)", "m/s^2"), Thrust("mean*diff", "W23(aL+aR)", "m/s^2"),
    Thrust("mean", "W23(bL-bR)", "m/s^2"), Thrust("diff/2", "W23(bL+bR)", "m/s^2")};
constexpr std::array kYawPaper = {
    Thrust("mean^2+diff^2/4", "W33(aL-aR)", "1/s^2"), Thrust("mean*diff", "W33(aL+aR)", "1/s^2"),
    Thrust("mean", "W33(bL-bR)", "1/s^2"), Thrust("diff/2", "W33(bL+bR)", "1/s^2")};

template <std::size_t N, std::size_t M>
constexpr std::array<Regressor, N + M> Concatenate(const std::array<Regressor, N>& body,
                                                   const std::array<Regressor, M>& propeller) {
  std::array<Regressor, N + M> all{};
  for (std::size_t i = 0; i < N; ++i) all[i] = body[i];
  for (std::size_t i = 0; i < M; ++i) all[N + i] = propeller[i];
  return all;
}

constexpr auto kSurgeInPropeller = Concatenate(kSurgeBody, kSurgePropeller);
constexpr auto kSwayInPropeller = Concatenate(kSwayBody, kSwayPropeller);
constexpr auto kYawInPropeller = Concatenate(kYawBody, kYawPropeller);
constexpr auto kSurgeInPaper = Concatenate(kSurgeBody, kSurgePaper);
constexpr auto kSwayInPaper = Concatenate(kSwayBody, kSwayPaper);
constexpr auto kYawInPaper = Concatenate(kYawBody, kYawPaper);

// Adds delta^2 and delta of one propeller to its forward or reverse terms, weighted by `side`.
void AddPropeller(double delta, double side, std::span<double> part) {
  const std::size_t first = delta >= 0.0 ? 0 : 2;
  part[first] += side * delta * delta;
  part[first + 1] += side * delta;
}

void FillPropellers(double starboard_side, const PropellerCommand& delta, std::span<double> part) {
  AddPropeller(delta.port, 1.0, part);
  AddPropeller(delta.starboard, starboard_side, part);
}

// The sign of a_L - a_R in the paper's sway and yaw rows: the two propellers have the same
// coefficients in FF and RR, forward minus reverse in FR, its opposite in RF.
double DifferenceSign(PropellerRegion region) {
  if (region == PropellerRegion::kFR) return 1.0;
  if (region == PropellerRegion::kRF) return -1.0;
  return 0.0;
}

ThrustRegressors PaperThrust(const PropellerCommand& delta) {
  const double mean = delta.Mean();
  const double diff = delta.Difference();
  const double square = mean * mean + diff * diff / 4.0;
  const double sign = DifferenceSign(RegionOf(delta));
  return {{square, mean}, {sign * square, mean * diff, sign * mean, diff / 2.0}};
}

ThrustRegressors PropellerThrust(const PropellerCommand& delta) {
  ThrustRegressors thrust;
  FillPropellers(1.0, delta, thrust.surge);
  FillPropellers(-1.0, delta, thrust.turning);
  return thrust;
}

void CopyBody(Equation equation, const BodyRow& body, std::span<double> row) {
  if (equation == Equation::kSurge) {
    std::ranges::copy(body.surge, row.begin());
  } else {
    std::ranges::copy(body.turning, row.begin());
  }
}

}  // namespace

std::span<const Regressor> Regressors(Equation equation, Parameterization parameterization) {
  Require(parameterization != Parameterization::kUnknown, "a named parameterization");
  const bool paper = parameterization == Parameterization::kPaper;
  switch (equation) {
    case Equation::kSurge:
      return paper ? std::span<const Regressor>(kSurgeInPaper) : kSurgeInPropeller;
    case Equation::kSway:
      return paper ? std::span<const Regressor>(kSwayInPaper) : kSwayInPropeller;
    case Equation::kYaw: return paper ? std::span<const Regressor>(kYawInPaper) : kYawInPropeller;
    case Equation::kUnknown: break;
  }
  throw ContractViolation("Regressors: requires a named equation");
}

std::size_t BodyRegressors(Equation equation) {
  return equation == Equation::kSurge ? kSurgeBody.size() : kSwayBody.size();
}

ThrustRegressors ThrustOf(Parameterization parameterization, const PropellerCommand& delta) {
  return parameterization == Parameterization::kPaper ? PaperThrust(delta) : PropellerThrust(delta);
}

void FillBody(Equation equation, const Nu& nu, std::span<double> row) {
  CopyBody(equation, BodyRowAt(nu), row);
}

void FillRow(Equation equation, const BodyRow& body, const ThrustRegressors& thrust,
             std::span<double> row) {
  CopyBody(equation, body, row);
  const auto part = row.subspan(BodyRegressors(equation));
  std::copy_n(thrust.Of(equation).begin(), part.size(), part.begin());
}

void FillRow(Equation equation, const Nu& nu, const ThrustRegressors& thrust,
             std::span<double> row) {
  FillRow(equation, BodyRowAt(nu), thrust, row);
}

void FillRow(Equation equation, Parameterization parameterization, const Nu& nu,
             const PropellerCommand& delta, std::span<double> row) {
  FillRow(equation, nu, ThrustOf(parameterization, delta), row);
}

}  // namespace telltale
