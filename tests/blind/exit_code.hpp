#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

namespace blind {

/// Nothing is refused with an exit code of its own.
class NoRefusal : public std::exception {};

/// Parses the options of a program and runs it. Its exit code: 0; 2 where an option is wrong, 3
/// where `run` throws a Refusal, 1 where it throws anything else, with the reason.
template <class Refusal = NoRefusal, class Run>
int ExitCodeOf(CLI::App& app, const char* name, int argc, char** argv, Run run) {
  constexpr int kUsageError = 2;
  constexpr int kRefused = 3;
  const auto fail = [&](const std::exception& error, int code) {
    std::cerr << name << ": " << error.what() << '\n';
    return code;
  };
  try {
    app.parse(argc, argv);
    run();
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  } catch (const Refusal& error) {
    return fail(error, kRefused);
  } catch (const std::exception& error) {
    return fail(error, 1);
  }
}

}  // namespace blind
