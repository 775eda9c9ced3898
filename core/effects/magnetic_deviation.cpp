#include <algorithm>
#include <cmath>
#include <numbers>

#include "telltale/core/effects/effect_instance.hpp"
#include "telltale/core/effects/wording.hpp"

namespace telltale {
namespace {

constexpr double kTypicalDeviation =
    0.05;  // rad: 3 degrees, of a compass beside motors without compensation
constexpr double kLargestDeviation = 0.5;
constexpr int kHeadingsStated = 72;

}  // namespace

class MagneticDeviationEffect final : public Effect {
 public:
  MagneticDeviationEffect()
      : Effect(
            {.name = "magnetic_deviation",
             .title = "a compass whose error changes with the heading",
             .equation = "psi_measured = psi + B sin psi + C cos psi + D sin 2 psi + E cos 2 psi; "
                         "the constant A is heading_bias",
             .source = "Handbook of Magnetic Compass Adjustment, NGA Pub. 226, 2004: coefficients "
                       "A to E of the deviation; of true headings here, which turns B with C and "
                       "D with E by the variation",
             .parameters = {{"B", "rad", kTypicalDeviation, -kLargestDeviation, kLargestDeviation},
                            {"C", "rad", kTypicalDeviation, -kLargestDeviation, kLargestDeviation},
                            {"D", "rad", kTypicalDeviation, -kLargestDeviation, kLargestDeviation},
                            {"E", "rad", kTypicalDeviation, -kLargestDeviation, kLargestDeviation}},
             .settled_by = "a second GNSS antenna",
             .hook = Hook::kHeading}) {}

  std::string Describe(EffectValues values) const override {
    double largest = 0.0;
    for (int i = 0; i < kHeadingsStated; ++i) {
      const double psi = 2.0 * std::numbers::pi * i / kHeadingsStated;
      largest = std::max(largest, std::abs(HeadingErrorRad(values, psi)));
    }
    return "heading off by up to " + FormatNumber(largest * 180.0 / std::numbers::pi, 1) +
           " deg, by its direction";
  }

  double HeadingErrorRad(EffectValues values, double psi_rad) const override {
    const double sine = std::sin(psi_rad);
    const double cosine = std::cos(psi_rad);
    const double sine_of_twice = 2.0 * sine * cosine;
    const double cosine_of_twice = cosine * cosine - sine * sine;
    return values[0] * sine + values[1] * cosine + values[2] * sine_of_twice +
           values[3] * cosine_of_twice;
  }
};

template const Effect& InstanceOf<MagneticDeviationEffect>();

}  // namespace telltale
