#pragma once

#include <functional>
#include <string>

namespace telltale {

/// Takes what a user should know of an answer that was given all the same: a sentence without its
/// stop.
using NoteSink = std::function<void(const std::string& note)>;

}  // namespace telltale
