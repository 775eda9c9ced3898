#pragma once

#include <cstddef>

#include "telltale/core/data/prepared_dataset.hpp"

namespace telltale {

/// The half width, in rows, of the Savitzky-Golay filter that suits the weak form. It is the least
/// one that leaves the noise of sway at half of sway's standard deviation; sway varies least. It is
/// at least 0.8 s, 1.6 s for recordings of a quarter of an hour or more, and at most 16 rows.
/// Noisy velocities weaken the instruments of their products. A wide filter distorts products,
/// which the model corrects only as far as it predicts them, and leaves short recordings with few
/// supports.
/// `preview`: the same recording, prepared with any width.
std::size_t SmoothingFor(const PreparedDataset& preview);

}  // namespace telltale
