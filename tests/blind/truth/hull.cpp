#include "hull.hpp"

#include <cmath>
#include <cstdio>

namespace blind::truth {
namespace {

constexpr std::array<const char*, 4> kDevelopmentNames{"tern", "plover", "gannet", "dunlin"};
constexpr std::array<const char*, 4> kHeldOutNames{"curlew", "avocet", "godwit", "whimbrel"};

Hull Drawn(const std::string& name, RandomStream rng) {
  Hull hull;
  hull.name = name;
  hull.demihull_spacing_m = rng.Uniform(0.6, 0.85);
  hull.mass_kg = rng.Uniform(25.0, 50.0);
  hull.x_g_m = rng.Uniform(-0.05, 0.05);
  const double radius_of_gyration_m = rng.Uniform(0.37, 0.44);
  hull.inertia_z_kgm2 =
      hull.mass_kg * (radius_of_gyration_m * radius_of_gyration_m + hull.x_g_m * hull.x_g_m);
  hull.added_surge_kg = hull.mass_kg * rng.Uniform(0.05, 0.10);
  hull.added_sway_kg = hull.mass_kg * rng.Uniform(0.45, 0.70);
  hull.added_coupling_kgm = hull.added_sway_kg * rng.Uniform(-0.05, 0.05);
  hull.added_yaw_kgm2 = hull.added_sway_kg * rng.Uniform(0.10, 0.15);

  // Heavier boats float deeper.
  const double wetted = hull.mass_kg / 35.0;
  hull.surge_linear = rng.Uniform(5.0, 9.0);
  hull.surge_quadratic = rng.Uniform(0.8, 1.1) * (9.0 + 10.0 * wetted);
  hull.surge_cubic = rng.Uniform(0.8, 2.2);
  hull.sway_linear = wetted * rng.Uniform(7.0, 14.0);
  hull.sway_cubic = rng.Uniform(8.0, 20.0);
  hull.yaw_linear = std::sqrt(wetted) * rng.Uniform(10.0, 14.0);
  hull.yaw_cubic = rng.Uniform(2.0, 5.0);
  hull.crossflow = wetted * rng.Uniform(50.0, 80.0);
  hull.crossflow_centre = rng.Uniform(-0.15, 0.15);
  hull.skeg_lift = wetted * rng.Uniform(22.0, 30.0);
  hull.skeg_x_m = rng.Uniform(-0.5, -0.4);

  hull.propeller_separation_m = rng.Uniform(0.6, 0.9);
  hull.propeller_x_m = rng.Uniform(-0.55, -0.4);
  hull.thrust_kept = rng.Uniform(0.86, 0.94);
  hull.port_share = 1.0 + rng.Normal(0.006);
  hull.starboard_share = 1.0 + rng.Normal(0.006);
  hull.motor_lag_s = rng.Uniform(0.05, 0.12);
  hull.inflow_loss = rng.Uniform(0.05, 0.10);

  hull.frontal_area_m2 = rng.Uniform(0.15, 0.22);
  hull.lateral_area_m2 = rng.Uniform(0.30, 0.45);
  hull.windage_lever = rng.Uniform(0.05, 0.12);
  hull.antenna_forward_m = rng.Uniform(-0.25, 0.25);
  hull.antenna_starboard_m = rng.Uniform(-0.1, 0.1);
  hull.clocks = {.commands_s = rng.Uniform(-0.05, 0.05),
                 .fixes_s = rng.Uniform(0.0, 0.1),
                 .headings_s = rng.Uniform(0.0, 0.04)};
  return hull;
}

}  // namespace

std::vector<Hull> Fleet(Set set, std::uint64_t seed) {
  const bool development = set == Set::kDevelopment;
  const RandomStream yard =
      RandomStream(seed).For(development ? "development yard" : "held-out yard");
  std::vector<Hull> fleet;
  for (const char* name : development ? kDevelopmentNames : kHeldOutNames) {
    fleet.push_back(Drawn(name, yard.For(name)));
  }
  return fleet;
}

std::string VehicleFile(const Hull& hull) {
  std::array<char, 640> text{};
  std::snprintf(text.data(), text.size(),
                "vehicle_id: \"%s\"\n"
                "propeller_separation_m: %.3f\n"
                "port      { neutral_us: 1500 full_forward_us: 1900 full_reverse_us: 1100 }\n"
                "starboard { neutral_us: 1500 full_forward_us: 1900 full_reverse_us: 1100 }\n"
                "gnss_antenna { forward_m: %.3f starboard_m: %.3f }\n"
                "mass_kg: %.1f\n",
                hull.name.c_str(), hull.propeller_separation_m, hull.antenna_forward_m,
                hull.antenna_starboard_m, hull.mass_kg);
  return text.data();
}

}  // namespace blind::truth
