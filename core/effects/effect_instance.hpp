#pragma once

#include "telltale/core/effects/effect.hpp"

namespace telltale {

/// The one instance of an effect. The effect's own file instantiates this template, and
/// effect_library.cpp, which sees the declaration alone, lists it. Thread-safe.
template <class DerivedEffect>
const Effect& InstanceOf() {
  static const DerivedEffect effect;
  return effect;
}

}  // namespace telltale
