#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>

#include "telltale/client/bus/participant.hpp"

namespace telltale {

/// Waits until daemons report on the quality of all these vehicles. Returns those that none reports
/// on within `timeout`. `waiting` is told now and then how many there still are.
std::set<std::string> AwaitServed(const Participant& participant, std::set<std::string> vehicle_ids,
                                  std::chrono::nanoseconds timeout,
                                  const std::function<void(std::size_t)>& waiting = {});

}  // namespace telltale
