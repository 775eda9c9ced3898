#pragma once

#include <string>

#include "telltale/idl/codec/messages/diagnosis.hpp"
#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// What to do about a vehicle that has drifted from its model: ask why, or act on the answer.
/// `diagnosis` is the vehicle's last, null where there is none. It is the answer where it is about
/// the model of `quality` and was published after the onset of the drift.
std::string DriftAdvice(const Quality& quality, const PublishedDiagnosis* diagnosis);

}  // namespace telltale
