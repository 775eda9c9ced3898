#pragma once

#include <string>

#include "telltale/idl/codec/messages/model.hpp"

namespace telltale {

/// model.json of a published model: with its revision and time.
std::string PrintModelJson(const PublishedModel& model);

}  // namespace telltale
