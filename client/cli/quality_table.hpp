#pragma once

#include <map>
#include <string>

#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// The fleet's quality for people: a row per vehicle, under it what was set aside and why.
std::string QualityTable(const std::map<std::string, Quality>& fleet);

}  // namespace telltale
