#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace telltale {

/// Takes the messages of one topic, each with the time at which it was recorded. Null: they are of
/// no use.
using MessageTaker =
    std::function<void(std::int64_t received_ns, std::span<const std::uint8_t> message)>;

}  // namespace telltale
