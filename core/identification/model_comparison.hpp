#pragma once

#include <string>

#include "telltale/core/base/result.hpp"
#include "telltale/core/identification/identification.hpp"
#include "telltale/core/uncertainty/wald.hpp"

namespace telltale {

/// Do two models of one boat differ by more than their errors: has the hull fouled, a blade bent?
/// TestEquality() of the coefficients both know, matched by equation and regressor, and of the
/// thruster time constant; indices in the result are places in first.coefficients, the one past the
/// last of them that of the time constant. The regressor "1" is left out: wind and current are no
/// property of the boat and differ from day to day. Covariances count as estimated from the
/// clusters of their residuals, or from the slices of the window or the replicates, whichever are
/// fewer, where they were bootstrapped; as known where they rest on white residuals.
/// Of the physical form its parameters are compared, without the delays between the clocks;
/// indices are places in PhysicalModel::parameters.
/// Assumes: windows that share no data. The bias both may have in common, by the noise in measured
/// velocities, cancels only where they were recorded and prepared alike.
/// Refuses when: structure, parameterization, estimator, sampling period or dead zone differ, since
/// coefficients then mean different things; or as TestEquality().
Result<WaldTest> TestForChange(const Identification& first, const Identification& second);

/// Whether coefficients of the two mean the same: what TestForChange() asks first.
bool AreComparable(const Identification& first, const Identification& second);

/// Whether, by one clock, some of the data behind one may be behind the other too.
bool WindowsOverlap(const Identification& first, const Identification& second);

/// TestForChange() in words and with a verdict at kSignificantChange: every coefficient both know,
/// the most significant first. Refuses as TestForChange().
Result<ModelChange> ChangeBetween(const Identification& earlier, const Identification& later);

/// "The models differ, p = 0.002."
std::string AnswerOf(const ModelChange& change);

}  // namespace telltale
