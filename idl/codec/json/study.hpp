#pragma once

#include <string>

#include "telltale/core/paper/study.hpp"
#include "telltale/idl/proto/study.pb.h"

namespace telltale {

/// Study -> the message behind study.json. What was refused is left empty.
proto::Study ToProto(const Study& study);

std::string PrintStudyJson(const Study& study);

}  // namespace telltale
