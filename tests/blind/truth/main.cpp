#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <stdexcept>

#include "campaign.hpp"
#include "effects.hpp"

namespace {

constexpr int kUsageError = 2;

struct Arguments {
  blind::truth::Set set = blind::truth::Set::kDevelopment;
  std::string folder;
  std::uint64_t seed = 1;
  std::size_t repeats = 1;
  std::size_t nominal_days = 0;
  std::size_t most_cases = 0;
  double duration_s = 600.0;
  std::vector<std::string> effects;
  std::vector<double> sizes;
  double sign = 1.0;
  std::string hull;
  double onset_s = 0.0;
  bool again = false;
  bool nominal = false;
  bool unseal = false;
  bool list = false;
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--set", arguments.set, "development (default) or held-out")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(std::map<std::string, blind::truth::Set>{
                                              {"development", blind::truth::Set::kDevelopment},
                                              {"held-out", blind::truth::Set::kHeldOut}})
                      .description(""));
  app.add_option("--out", arguments.folder, "the folder to write to, made where it is missing")
      ->type_name("DIR");
  app.add_option("--seed", arguments.seed, "of everything drawn (default 1)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber.description(""));
  app.add_option("--duration", arguments.duration_s,
                 "of each recording, seconds, [10, 3600] (default 600)")
      ->type_name("S")
      ->check(CLI::Range(10.0, 3600.0).description(""));

  CLI::App* whole = app.add_option_group("whole sets");
  whole->add_option("--repeats", arguments.repeats, "so many times each case, [1, 20] (default 1)")
      ->type_name("N")
      ->check(CLI::Range(1, 20).description(""));
  whole
      ->add_option("--nominal-days", arguments.nominal_days,
                   "in place of the set's cases so many days with nothing wrong, [1, 1000]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000).description(""))
      ->excludes("--repeats");
  whole->add_option("--cases", arguments.most_cases, "no more than the first N cases")
      ->type_name("N")
      ->check(CLI::PositiveNumber.description(""));
  whole->add_flag(
      "--again", arguments.again,
      "also simulate each case a second time: cases/NNN/again, the same but for mission, "
      "gusts and noise");

  CLI::App* single = app.add_option_group("single cases");
  single->add_option("--effect", arguments.effects, "the effect to turn on, several for several")
      ->type_name("NAME");
  single
      ->add_option("--size", arguments.sizes,
                   "of each effect in turn, times typical, (0, 4] (default 1)")
      ->type_name("S")
      ->check(CLI::Range(1e-6, 4.0).description(""));
  single->add_option("--sign", arguments.sign, "of those that have one, -1 or 1 (default)")
      ->type_name("SIGN")
      ->check(CLI::IsMember({-1.0, 1.0}).description(""));
  single->add_option("--hull", arguments.hull, "the boat (default: the set's first)")
      ->type_name("NAME");
  single->add_option("--onset", arguments.onset_s, "when it sets in, seconds (default 0)")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber.description(""));
  single->add_flag("--nominal", arguments.nominal, "a single case with nothing wrong");
  single->add_flag("--unseal", arguments.unseal, "print the label");
  app.add_flag("--list-effects", arguments.list, "name the effects and exit");
}

void ListEffects() {
  for (const blind::truth::Effect& effect : blind::truth::Effects()) {
    std::cout << effect.name << (effect.has_sign ? " (either sign)" : "")
              << (effect.in_library ? "" : " (not in the library)") << '\n';
  }
}

void ShowProgress(std::size_t done, std::size_t all) {
  std::fprintf(stderr, "\rblind_truth: %zu of %zu recordings%s", done, all,
               done == all ? "\n" : "");
}

void WriteSet(const Arguments& arguments) {
  blind::truth::CampaignOptions options{.set = arguments.set,
                                        .seed = arguments.seed,
                                        .repeats = arguments.repeats,
                                        .nominal_days = {},
                                        .most_cases = {},
                                        .duration_s = arguments.duration_s,
                                        .again = arguments.again};
  if (arguments.nominal_days > 0) options.nominal_days = arguments.nominal_days;
  if (arguments.most_cases > 0) options.most_cases = arguments.most_cases;
  blind::truth::WriteCampaign(options, arguments.folder, ShowProgress);
}

void WriteOne(const Arguments& arguments) {
  if (arguments.sizes.size() > std::max<std::size_t>(1, arguments.effects.size())) {
    throw std::invalid_argument("--size: there are more sizes than effects");
  }
  blind::truth::SingleCaseOptions options{.set = arguments.set,
                                          .seed = arguments.seed,
                                          .hull = arguments.hull,
                                          .effects = {},
                                          .onset_s = arguments.onset_s,
                                          .duration_s = arguments.duration_s};
  for (std::size_t at = 0; at < arguments.effects.size(); ++at) {
    const double size = at < arguments.sizes.size() ? arguments.sizes[at] : 1.0;
    options.effects.push_back({arguments.effects[at], size, arguments.sign});
  }
  const std::string label = blind::truth::WriteSingleCase(options, arguments.folder);
  if (arguments.unseal) std::cout << label << '\n';
}

void Run(const Arguments& arguments) {
  if (arguments.list) return ListEffects();
  if (arguments.folder.empty()) throw std::invalid_argument("--out is required");
  if (arguments.nominal && !arguments.effects.empty()) {
    throw std::invalid_argument("--nominal excludes --effect");
  }
  if (arguments.nominal || !arguments.effects.empty()) return WriteOne(arguments);
  if (!arguments.hull.empty() || arguments.unseal || !arguments.sizes.empty()) {
    throw std::invalid_argument("--hull, --size and --unseal go with --effect or --nominal");
  }
  WriteSet(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Simulates boats of its own making and records them, with or without something wrong");
  app.footer(
      "Without --effect or --nominal it writes a whole set: hulls/, cases/ and labels/ below DIR.\n"
      "Labels are sealed; only blind_score and blind_fit open them.\n"
      "Example: blind_truth --set development --out build/blind/development\n"
      "         blind_truth --effect wind --size 2 --hull tern --unseal --out one");
  Arguments arguments;
  AddOptions(app, arguments);
  try {
    app.parse(argc, argv);
    Run(arguments);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  } catch (const std::invalid_argument& error) {
    std::cerr << "blind_truth: " << error.what() << '\n';
    return kUsageError;
  } catch (const std::exception& error) {
    std::cerr << "blind_truth: " << error.what() << '\n';
    return 1;
  }
}
