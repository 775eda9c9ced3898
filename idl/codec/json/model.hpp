#pragma once

#include <string>
#include <string_view>

#include "telltale/core/identification/identification.hpp"
#include "telltale/idl/codec/codec_error.hpp"
#include "telltale/idl/proto/model.pb.h"

namespace telltale {

/// Identification -> the message of model.json. Revision and time of publication stay zero: the
/// publisher sets them. Counts beyond 32 bits saturate.
proto::Model ToProto(const Identification& identification);

/// The way back. Errors name the fields as model.json does; `file` is their name for the text.
/// Refuses: an unset structure, parameterization or estimator, a sampling period outside its range,
/// an id that is none, and what ReadEstimates(), ReadWindow(), ReadProvenance(), ModelFault(),
/// ReadExcitation(), ReadManoeuvreAdvice() and ReadCoverageCheck() refuse.
Decoded<Identification> IdentificationOf(const proto::Model& model,
                                         const std::string& file = "model");

/// model.json.
std::string PrintModelJson(const Identification& identification);

/// The way back. Refuses also: text that is not JSON, unknown fields, and models that an older
/// version of this software wrote, OutdatedModel().
Decoded<Identification> ParseModelJson(std::string_view text, const std::string& file = "model");

}  // namespace telltale
