#include "telltale/client/cli/exit_codes.hpp"

#include "telltale/client/cli/table.hpp"

namespace telltale {

std::string Explained(const Refusal& refusal) {
  return Wrapped(refusal.subject + ": " + refusal.reason, "  ") +
         Wrapped("-> " + refusal.advice, "     ");
}

}  // namespace telltale
