#include "telltale/client/report/grouped_error.hpp"

#include <cmath>

namespace telltale {
namespace {

double RootMean(double squares, std::size_t count) {
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

}  // namespace

void GroupedError::Add(const WindowPicture& window) {
  ++windows_;
  before_squares_ += window.before * window.before;
  after_squares_ += window.after * window.after;
}

double GroupedError::Before() const {
  return RootMean(before_squares_, windows_);
}

double GroupedError::After() const {
  return RootMean(after_squares_, windows_);
}

}  // namespace telltale
