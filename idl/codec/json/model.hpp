#pragma once

#include <string>
#include <string_view>

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// Identification -> the message that rests in model.json. Revision and time of publication stay
/// zero: who publishes sets them. Counts beyond 32 bits saturate.
proto::Model ToProto(const Identification& identification);

/// The parts other messages share.
proto::Coefficient ToProto(const Coefficient& coefficient);
proto::Refusal ToProto(const Refusal& refusal);

/// The way back. Names of fields in errors are those of model.json; `file` is what they call the
/// text. Refuses: an unset structure, parameterization, estimator or status; an equation whose
/// coefficients are not those of Regressors() in that order, with their symbols and units; numbers
/// that are NaN, an infinite estimate, a negative standard error, bounds the wrong way round; a
/// covariance that is not n^2 long, has a negative variance or is not symmetric; a thruster time
/// constant without the dynamic structure or the reverse; a covariance of it that has not one
/// number for each coefficient (none at all, as in older files, means zero); a dead zone out of its
/// range; effects that the library lacks, or whose parameters are not its own, in its order and
/// ranges; unknown channels and reject reasons.
Decoded<Identification> IdentificationOf(const proto::Model& model,
                                         const std::string& file = "model");

/// model.json.
std::string PrintModelJson(const Identification& identification);
Decoded<Identification> ParseModelJson(std::string_view text, const std::string& file = "model");

}  // namespace telltale
