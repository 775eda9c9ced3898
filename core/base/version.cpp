#include "telltale/core/base/version.hpp"

namespace telltale {

std::string_view Version() {
  return TELLTALE_VERSION;
}

}  // namespace telltale
