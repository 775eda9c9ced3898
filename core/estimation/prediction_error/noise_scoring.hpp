#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "telltale/core/data/prepared_dataset.hpp"
#include "telltale/core/estimation/prediction_error/extended_kalman_filter.hpp"
#include "telltale/core/estimation/prediction_error/noise_model.hpp"

namespace telltale {

/// Process noise wide enough that the filter follows the readings whatever the parameters are. Far
/// above the accelerations of a slow boat it would leave nothing for the parameters to explain.
NoiseModel FirstNoise(const PreparedDataset& dataset);

/// Below which noise is not sought.
enum class NoiseFloor {
  /// The readings of a boat are smoother than they are true: an autopilot filters its fixes and
  /// headings. Less noise would let the filter follow the readings instead of the model.
  kOfReadings,
  /// A boat of the instruments that follows the filter is free of what disturbs the boat only as
  /// far as the noise of the filter is right.
  kWhereFollowing
};

/// The settings of a filter of the boat under a noise.
using SettingsUnder = std::function<FilterSettings(const NoiseModel&)>;

/// The noise of each recording by maximum likelihood, under a weak log-normal prior that keeps a
/// noise finite which the data do not show. Five minutes of a recording show its noise well enough:
/// of a longer segment, five even excerpts of a minute.
class NoiseScoring {
 public:
  /// The dataset has to outlive it.
  NoiseScoring(const PreparedDataset& dataset, std::size_t threads);

  /// One step of Fisher scoring of the noise of each recording, at most a factor e; slopes by
  /// finite differences of its logarithm. The largest move of a logarithm.
  double Step(const SettingsUnder& settings_under, NoiseFloor floor,
              std::vector<NoiseModel>& noise) const;

 private:
  /// Readings of one segment.
  struct Excerpt {
    std::size_t segment = 0;
    RawSignals signals;
  };
  using Runs = std::vector<std::vector<Innovation>>;  // by noise

  static std::vector<Excerpt> ExcerptsOf(const PreparedDataset& dataset);
  std::vector<Runs> RunsUnder(const std::vector<std::vector<NoiseModel>>& of_recordings,
                              const SettingsUnder& settings_under) const;

  const PreparedDataset& dataset_;
  std::size_t threads_;
  std::vector<Excerpt> excerpts_;
};

}  // namespace telltale
