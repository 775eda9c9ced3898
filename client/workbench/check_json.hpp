#pragma once

#include <string>
#include <vector>

#include "telltale/client/workbench/check_log.hpp"

namespace telltale {

/// The text of a check.json: what each log holds, its faults and delays, in the order of `logs`.
std::string PrintCheckJson(const std::vector<CheckedLog>& logs);

}  // namespace telltale
