#include "cli/outcome.hpp"

#include "cli/table.hpp"

namespace telltale {

std::string Explained(const Refusal& refusal) {
  return Wrapped(refusal.subject + ": " + refusal.reason, "  ") +
         Wrapped("-> " + refusal.advice, "     ");
}

}  // namespace telltale
