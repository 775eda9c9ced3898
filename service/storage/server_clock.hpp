#pragma once

#include <string_view>

namespace telltale {

/// The time in SQL by the clock of the database of PostgreSQL, Unix seconds: those of the machines
/// that share it may differ.
inline constexpr std::string_view kServerNow =
    "CAST(EXTRACT(EPOCH FROM clock_timestamp()) AS DOUBLE PRECISION)";

}  // namespace telltale
