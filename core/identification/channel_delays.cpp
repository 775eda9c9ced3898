#include "telltale/core/identification/channel_delays.hpp"

#include <algorithm>
#include <optional>

#include "telltale/core/data/recording_parts.hpp"
#include "telltale/core/identification/identify.hpp"
#include "telltale/core/vessel/fossen_model.hpp"

namespace telltale {

Result<ChannelDelays> EstimateChannelDelays(const Recording& recording, const Vehicle& vehicle,
                                            std::size_t threads, const Progress& progress) {
  IdentifyOptions options;
  options.regression.structure = Structure::kFossen;
  options.threads = threads;
  const auto model = Identify(Liveliest(recording, kLongestDelayPartS), vehicle, options, progress);
  if (!model) return tl::unexpected(model.error());
  const auto delay = [&](FossenParameter parameter) {
    return model->physical->parameters[static_cast<std::size_t>(parameter)];
  };
  const auto unsettled = std::ranges::find(model->refusals, "model", &Refusal::subject);
  return ChannelDelays{
      delay(FossenParameter::kCommandDelay), delay(FossenParameter::kFixDelay),
      model->window.start_s, model->window.end_s,
      unsettled != model->refusals.end() ? std::optional(*unsettled) : std::nullopt};
}

}  // namespace telltale
