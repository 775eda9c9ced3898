#pragma once

#include <filesystem>

#include "simulated_run.hpp"

namespace blind::truth {

/// What the sensors make of a track, as telemetry files: GNSS at 5 Hz with 1 cm white and 1.5 cm
/// Gauss-Markov noise a horizontal axis, heading at 20 Hz with 0.2 and 0.15 degrees, commands
/// sampled at 10 Hz. Stamped in seconds of the Unix epoch by the hull's clocks, which differ
/// between channels, on the day of that number.
void WriteRecording(const Track& track, const SimulatedRun& simulated_run, std::size_t day,
                    RandomStream rng, const std::filesystem::path& folder);

/// Writes a file and its folders; throws std::runtime_error naming the file where that fails.
void WriteFile(const std::filesystem::path& file, const std::string& content);

}  // namespace blind::truth
