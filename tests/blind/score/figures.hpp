#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "score/report.hpp"

namespace blind::score {

/// One case: what was on, what was said.
struct Scored {
  Label label;
  Report report;
  std::optional<Report> left_out;  // what is said without the true effect in the library
};

/// So many of so many.
struct Rate {
  std::size_t hits = 0;
  std::size_t all = 0;
  void Count(bool hit) {
    hits += hit ? 1 : 0;
    ++all;
  }
};

struct Interval {
  double lower;
  double upper;
};

/// Exact two-sided bounds of a proportion (Clopper and Pearson 1934), `level` in (0, 1).
Interval ClopperPearson(std::size_t hits, std::size_t all, double level);

/// The exact one-sided upper bound.
double ClopperPearsonUpper(std::size_t hits, std::size_t all, double level);

/// A probability that was given and whether it came true.
struct Forecast {
  double probability;
  bool right;
};

/// Mean squared distance of probability and outcome.
double Brier(const std::vector<Forecast>& forecasts);

/// Expected calibration error over ten equally wide bins: the mean distance between a bin's mean
/// probability and the share that came true, by the bin's forecasts.
double CalibrationError(const std::vector<Forecast>& forecasts);

/// The likeliest cause, or nothing where the verdict says that there is no gap or too little data.
const Cause* FirstCause(const Report& report);

/// What the report calls the gap in a table: the first cause's effects, or the verdict where none.
std::string CalledBy(const Report& report);

/// The true effects, with or without the weather beside them, are the first cause's, or each is one
/// of them or indistinguishable from one of them, as many as they are. For a case outside the
/// library: the first cause is unknown, or the weather that is there; for a nominal one: the
/// latter.
bool ClassHit(const Scored& scored);

/// Nothing is named but the weather that is there.
bool IsWeatherThatIsThere(const Cause* cause, const Label& label);

/// Whether any effect of the cause is known to look like any of the true ones.
bool IsConfusable(const Cause& cause, const EffectSet& truth);

/// Whether the interval holds that direction.
bool Holds(const Direction& interval, double direction_deg);

bool IsUnknown(const Cause& cause);

/// How many single effects the first cause stands for.
std::size_t ClassSize(const Cause& cause);

struct NamingRates {
  Rate top_1;
  Rate top_3;
  Rate class_hit;
  Rate named_hit;                   // of all: a class hit that the verdict names outright
  std::vector<double> class_sizes;  // where a cause of the library was named
};

struct EffectFigures {
  NamingRates naming;
  std::vector<double> detectability;
  std::map<std::string, std::size_t> called;  // the row of the confusion table
};

/// Of one kind of weather where the first cause names it.
struct DirectionFigures {
  Rate told;                            // its interval is no half circle
  Rate held;                            // of these: it holds the true direction
  std::vector<double> half_widths_deg;  // of these
};

inline constexpr double kDetectable = 10.0;

struct Figures {
  NamingRates all;  // single effects
  // Of them those whose own report has the true effect at kDetectable or more: at its typical size,
  // and at the size that it has.
  NamingRates detectable;
  NamingRates detectable_as_it_is;
  Rate false_alarms;   // nominal: a gap put down to anything but the weather that is there
  Rate weather_named;  // nominal, in weather: that is the first cause
  Rate wrongly_named;  // outside the library: called EXPLAINED, or by an effect at more than 0.5
  Rate outside_seen;   // outside the library: a gap was reported at all
  Rate exact_pairs;    // both of two effects and no other, each up to its class
  Rate half_pairs;     // at least one of the two
  Rate confidently_wrong;        // true effect left out, gap seen: the verdict names one unlike it
  Rate unrelated_named;          // of all that too, by nothing that is known to look like it either
  Rate absent_named;             // of these, by more than the weather that is there
  Rate indistinguishable_named;  // likewise, by one that the report with it cannot tell it from
  std::vector<Forecast> forecasts;           // of each first cause there was
  std::vector<double> closures;              // predicted, where a class was hit
  std::vector<double> closure_errors;        // |predicted - realised|, where realised is known
  std::vector<double> named_closure_errors;  // of them where the verdict names a cause outright
  std::map<std::string, DirectionFigures> directions;  // by weather
  std::map<std::string, EffectFigures> effects;        // by true effects, "nominal" among them
};

Figures FiguresOf(const std::vector<Scored>& cases);

double Mean(const std::vector<double>& values);  // NaN of none
double Median(std::vector<double> values);       // likewise

}  // namespace blind::score
