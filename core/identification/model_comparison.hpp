#pragma once

#include "identification/identification.hpp"
#include "result.hpp"
#include "uncertainty/wald.hpp"

namespace telltale {

/// Do two models of one boat differ by more than their errors: has the hull fouled, a blade bent?
/// TestEquality() of the coefficients both know, matched by equation and regressor, and of the
/// thruster time constant; indices in the result are places in first.coefficients, the one past the
/// last of them that of the time constant. Covariances count as estimated from the segments of the
/// window where they were bootstrapped, as known where they rest on residuals.
/// Assumes: windows that share no data. The bias both may have in common, by the noise in measured
/// velocities, cancels only where they were recorded and prepared alike.
/// Refuses when: structure, parameterization, estimator, sampling period or dead zone differ, since
/// coefficients then mean different things; or as TestEquality().
Result<WaldTest> Compare(const Identification& first, const Identification& second);

}  // namespace telltale
