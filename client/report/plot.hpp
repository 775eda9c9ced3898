#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "telltale/client/report/markup.hpp"

namespace telltale {

/// Values from `low` to `high` on pixels from `from` to `to`; beyond them, and where a value is not
/// finite, the nearer end. Requires: low < high.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;
  double to = 1.0;

  double operator()(double value) const;
};

/// Round numbers 1, 2 or 5 times a power of ten apart, from zero to the first that is not below
/// `highest`, at most `most` + 1 of them. Something sensible where `highest` is not positive or not
/// finite.
std::vector<double> TicksUpTo(double highest, std::size_t most);

/// The largest of the finite values, 0 where there is none.
double LargestFinite(const std::vector<double>& values);

/// A number for an attribute of SVG.
std::string Pixels(double value);

// ---- shapes; `style` is a class of style.cpp ----------------------------------------------------

Markup LineShape(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view style);
Markup RectangleShape(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                      std::string_view style);
Markup CircleShape(const Eigen::Vector2d& centre, double radius, std::string_view style);
Markup PathShape(const std::vector<Eigen::Vector2d>& points, std::string_view style);

/// A shape, or several, over which a pointer shows `text`.
Markup Titled(std::string_view text, const Markup& shape);

enum class Anchor { kStart, kMiddle, kEnd };

Markup LabelShape(const Eigen::Vector2d& at, std::string_view text, Anchor anchor,
                  std::string_view style = "");

/// A picture of that many pixels, which shrinks or grows with its column; `description` is what a
/// screen reader says of it.
Markup Picture(const Eigen::Vector2d& size, std::string_view style, std::string_view description,
               const Markup& shapes);

}  // namespace telltale
