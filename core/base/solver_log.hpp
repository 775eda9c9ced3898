#pragma once

namespace telltale {

/// Keeps the log lines of Ceres Solver off standard error: what matters of a solution is in its
/// result. Process-wide; call it at the start of main. A fatal line still ends the process.
void SilenceSolverLog();

}  // namespace telltale
