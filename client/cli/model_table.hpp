#pragma once

#include <string>

#include "telltale/core/identification/identification.hpp"

namespace telltale {

/// A model for people, within 100 columns: one row per coefficient with its bounds, refusals under
/// it, then the window it rests on, what was set aside there, and what the bounds rest on.
std::string ModelTable(const Identification& identification);

/// The coefficients times the sampling period, as the paper's tables hold them, and alpha.
std::string DiscreteTable(const Identification& identification);

/// "gnss 7 DUPLICATE, thrusters 2 NOT_FINITE", or "nothing".
std::string RejectedText(const RejectCounts& rejected);

}  // namespace telltale
