#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace telltale {

/// Thrown when a caller breaks a documented precondition: a defect in the program, not in the data.
class ContractViolation : public std::logic_error {
  using std::logic_error::logic_error;
};

/// Checks a precondition in every build type, release included.
inline void Require(bool holds, const char* condition,
                    std::source_location where = std::source_location::current()) {
  if (holds) return;
  throw ContractViolation(std::string(where.file_name()) + ":" + std::to_string(where.line()) +
                          ": requires " + condition);
}

}  // namespace telltale
