#pragma once

#include <string>

#include "proto/study.pb.h"
#include "validation/study.hpp"

namespace telltale {

/// Study -> the message behind study.json. What was refused is left empty.
proto::Study ToProto(const Study& study);

std::string PrintStudyJson(const Study& study);

}  // namespace telltale
