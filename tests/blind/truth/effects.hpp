#pragma once

#include <string>
#include <vector>

#include "random_stream.hpp"
#include "scenario.hpp"

namespace blind::truth {

struct Parameter {
  std::string name;
  double value;
  std::string unit;
};

/// Something wrong: how it changes the scenario at `size` times its typical strength. What else
/// there is to draw (a direction, a side) comes from the dice; the sign turns it where it has one.
struct Effect {
  std::string name;
  bool has_sign;
  bool in_library;  // of the diagnoser, by the names of the interfaces
  std::vector<Parameter> (*apply)(Scenario& scenario, double size, double sign, RandomStream& rng);
};

const std::vector<Effect>& Effects();

/// The effect of that name; throws std::invalid_argument naming all where there is none.
const Effect& EffectNamed(const std::string& name);

}  // namespace blind::truth
