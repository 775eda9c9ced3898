#pragma once

#include <optional>
#include <string_view>

namespace telltale {

/// Seconds since 1970 of a time such as "2023-11-14 22:13:20.5", "2023-11-14T22:13:20Z" or
/// "2023-11-14T23:13:20+01:00"; nothing of any other text. Without a zone it is taken as UTC.
/// Source: ISO 8601, calendar date and time of day in the extended format.
std::optional<double> SecondsOfIsoTime(std::string_view text);

}  // namespace telltale
