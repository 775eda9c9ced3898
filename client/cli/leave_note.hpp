#pragma once

#include <string>

namespace telltale {

/// While it lives, SIGINT and SIGTERM end the program with exit code 128 + signal and a note on
/// standard error of what goes on without it. One at a time. Assumes: threads that have begun
/// earlier do not block these signals.
class LeaveNote {
 public:
  explicit LeaveNote(const std::string& note);
  LeaveNote(const LeaveNote&) = delete;
  LeaveNote& operator=(const LeaveNote&) = delete;
  ~LeaveNote();

  /// The note from now on.
  void Change(const std::string& note);
};

}  // namespace telltale
