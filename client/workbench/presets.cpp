#include "telltale/client/workbench/presets.hpp"

#include "telltale/client/workbench/names.hpp"

namespace telltale {

const OptionNames& PresetNames() {
  static const OptionNames names = {"robust", "paper"};
  return names;
}

Preset PresetNamed(const std::string& name) {
  RequireOneOf(PresetNames(), "--preset", name);
  return name == "paper" ? Preset::kPaper : Preset::kRobust;
}

PrepareOptions PrepareOptionsOf(Preset preset) {
  return preset == Preset::kPaper ? PrepareOptions::Paper() : PrepareOptions::Robust();
}

PrepareOptions PrepareOptionsOf(const Identification& model,
                                const std::optional<std::string>& preset) {
  const bool paper = preset ? PresetNamed(*preset) == Preset::kPaper
                            : model.provenance.preset == Name(Preset::kPaper);
  PrepareOptions options = PrepareOptionsOf(paper ? Preset::kPaper : Preset::kRobust);
  options.sampling_period_s = model.sampling_period_s;
  return options;
}

}  // namespace telltale
