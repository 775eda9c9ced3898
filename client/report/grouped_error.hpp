#pragma once

#include <cstddef>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// Root mean square error of some windows, before and after, in times the normal error.
class GroupedError {
 public:
  void Add(const WindowPicture& window);

  std::size_t Windows() const { return windows_; }
  double Before() const;  ///< 0 without windows
  double After() const;

 private:
  std::size_t windows_ = 0;
  double before_squares_ = 0.0;
  double after_squares_ = 0.0;
};

}  // namespace telltale
