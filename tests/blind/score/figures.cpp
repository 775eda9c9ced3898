#include "score/figures.hpp"

#include <algorithm>
#include <array>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "score/confusable.hpp"

namespace blind::score {
namespace {

/// Whether the verdict names a cause outright.
bool IsSure(const Report& report) {
  return report.verdict == "EXPLAINED" || report.verdict == "PARTLY_EXPLAINED";
}

bool ReportsGap(const Report& report) {
  return IsSure(report) || report.verdict == "UNKNOWN_CAUSE";
}

bool Holds(const EffectSet& set, const EffectSet& part) {
  return std::includes(set.begin(), set.end(), part.begin(), part.end());
}

bool StandsFor(const Cause& cause, const EffectSet& truth) {
  if (cause.effects == truth || cause.indistinguishable_sets.contains(truth)) return true;
  EffectSet covered = cause.indistinguishable;
  covered.insert(cause.effects.begin(), cause.effects.end());
  return cause.effects.size() == truth.size() && Holds(covered, truth);
}

/// The true effects with the weather beside them.
EffectSet WithWeather(const Label& label) {
  EffectSet all = label.effects;
  all.insert(label.weather.begin(), label.weather.end());
  return all;
}

std::string Joined(const EffectSet& effects) {
  std::string text;
  for (const std::string& effect : effects) text += (text.empty() ? "" : " + ") + effect;
  return text;
}

/// The least detectability of the true effects in the case's own report, at these sizes, in typical
/// ones; 1 where none is given.
double Detectability(const Scored& scored, const std::map<std::string, double>& sizes = {}) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::string& effect : scored.label.effects) {
    const auto found = scored.report.detectability.find(effect);
    const auto size = sizes.find(effect);
    least = std::min(least, (found == scored.report.detectability.end() ? 0.0 : found->second) *
                                (size == sizes.end() ? 1.0 : size->second));
  }
  return least;
}

bool AmongFirst(const Report& report, std::size_t count, const Label& label) {
  if (!FirstCause(report)) return false;
  const auto end =
      report.causes.begin() + static_cast<std::ptrdiff_t>(std::min(count, report.causes.size()));
  return std::any_of(report.causes.begin(), end, [&](const Cause& cause) {
    return cause.effects == label.effects || cause.effects == WithWeather(label);
  });
}

void CountNaming(NamingRates& naming, const Scored& scored) {
  naming.top_1.Count(AmongFirst(scored.report, 1, scored.label));
  naming.top_3.Count(AmongFirst(scored.report, 3, scored.label));
  naming.class_hit.Count(ClassHit(scored));
  naming.named_hit.Count(ClassHit(scored) && IsSure(scored.report));
  const Cause* first = FirstCause(scored.report);
  if (first && !IsUnknown(*first)) {
    naming.class_sizes.push_back(static_cast<double>(ClassSize(*first)));
  }
}

void CountNominal(Figures& figures, const Scored& scored) {
  const bool weather = IsWeatherThatIsThere(FirstCause(scored.report), scored.label);
  figures.false_alarms.Count(ReportsGap(scored.report) && !weather);
  if (!scored.label.weather.empty()) figures.weather_named.Count(weather);
}

void CountPair(Figures& figures, const Scored& scored) {
  figures.exact_pairs.Count(ClassHit(scored));
  const Cause* first = FirstCause(scored.report);
  const auto named = [&](const std::string& effect) {
    return first && (first->effects.contains(effect) || first->indistinguishable.contains(effect));
  };
  const EffectSet& truth = scored.label.effects;
  figures.half_pairs.Count(std::any_of(truth.begin(), truth.end(), named));
}

void CountOutside(Figures& figures, const Scored& scored) {
  const Cause* first = FirstCause(scored.report);
  const bool named = first && !IsUnknown(*first) && !IsWeatherThatIsThere(first, scored.label) &&
                     first->probability > 0.5;
  figures.wrongly_named.Count(named || scored.report.verdict == "EXPLAINED");
  figures.outside_seen.Count(ReportsGap(scored.report));
}

/// Whether the report takes the cause for one that it cannot tell from the true effects.
bool IsNeighbour(const Cause& cause, const Scored& scored) {
  return std::any_of(scored.report.causes.begin(), scored.report.causes.end(),
                     [&](const Cause& own) {
                       return StandsFor(own, scored.label.effects) && StandsFor(own, cause.effects);
                     });
}

void CountLeftOut(Figures& figures, const Scored& scored) {
  if (!scored.left_out || !ReportsGap(*scored.left_out)) return;
  const Cause* first = FirstCause(*scored.left_out);
  const bool sure =
      first && !IsUnknown(*first) && first->probability > 0.5 && IsSure(*scored.left_out);
  const bool neighbour = first && IsNeighbour(*first, scored);
  const bool unrelated = sure && !neighbour && !IsConfusable(*first, scored.label.effects);
  figures.confidently_wrong.Count(sure && !neighbour);
  figures.unrelated_named.Count(unrelated);
  figures.absent_named.Count(unrelated && !IsWeatherThatIsThere(first, scored.label));
  figures.indistinguishable_named.Count(neighbour);
}

void CountDirections(Figures& figures, const Scored& scored) {
  const Cause* first = FirstCause(scored.report);
  if (!first) return;
  for (const auto& [weather, interval] : first->directions) {
    const auto truth = scored.label.towards_deg.find(weather);
    if (truth == scored.label.towards_deg.end()) continue;
    DirectionFigures& own = figures.directions[weather];
    const bool told = interval.half_width_deg < 90.0;
    own.told.Count(told);
    if (!told) continue;
    own.held.Count(Holds(interval, truth->second));
    own.half_widths_deg.push_back(interval.half_width_deg);
  }
}

void CountByEffect(Figures& figures, const Scored& scored) {
  const bool nominal = scored.label.kind == "nominal";
  const std::string name = nominal ? "nominal" : Joined(scored.label.effects);
  EffectFigures& own =
      figures.effects[scored.label.weather.empty() ? name
                                                   : name + ", in " + Joined(scored.label.weather)];
  ++own.called[CalledBy(scored.report)];
  if (nominal) return;
  CountNaming(own.naming, scored);
  own.detectability.push_back(Detectability(scored));
}

}  // namespace

Interval ClopperPearson(std::size_t hits, std::size_t all, double level) {
  const double tail = 0.5 * (1.0 - level);
  const auto k = static_cast<double>(hits), n = static_cast<double>(all);
  return {hits == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, tail),
          ClopperPearsonUpper(hits, all, 1.0 - tail)};
}

double ClopperPearsonUpper(std::size_t hits, std::size_t all, double level) {
  const auto k = static_cast<double>(hits), n = static_cast<double>(all);
  return hits == all ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, level);
}

double Brier(const std::vector<Forecast>& forecasts) {
  std::vector<double> squares;
  for (const Forecast& forecast : forecasts) {
    squares.push_back(std::pow(forecast.probability - (forecast.right ? 1.0 : 0.0), 2));
  }
  return Mean(squares);
}

double CalibrationError(const std::vector<Forecast>& forecasts) {
  constexpr std::size_t kBins = 10;
  std::array<double, kBins> excess{};  // of probability over what came true
  for (const Forecast& forecast : forecasts) {
    const auto bin = static_cast<std::size_t>(forecast.probability * kBins);
    excess[std::min(bin, kBins - 1)] += forecast.probability - (forecast.right ? 1.0 : 0.0);
  }
  double sum = 0.0;
  for (const double of_bin : excess) sum += std::abs(of_bin);
  return sum / static_cast<double>(forecasts.size());
}

const Cause* FirstCause(const Report& report) {
  return ReportsGap(report) && !report.causes.empty() ? &report.causes.front() : nullptr;
}

std::string CalledBy(const Report& report) {
  const Cause* first = FirstCause(report);
  return first ? Joined(first->effects) : report.verdict;
}

bool ClassHit(const Scored& scored) {
  const Cause* first = FirstCause(scored.report);
  if (!first) return false;
  const Label& label = scored.label;
  if (label.kind == "nominal") return IsWeatherThatIsThere(first, label);
  if (label.kind == "outside") return IsUnknown(*first) || IsWeatherThatIsThere(first, label);
  return StandsFor(*first, label.effects) || StandsFor(*first, WithWeather(label));
}

bool IsWeatherThatIsThere(const Cause* cause, const Label& label) {
  return cause && Holds(label.weather, cause->effects);
}

bool IsConfusable(const Cause& cause, const EffectSet& truth) {
  return std::any_of(cause.effects.begin(), cause.effects.end(), [&](const std::string& named) {
    return std::any_of(truth.begin(), truth.end(),
                       [&](const std::string& effect) { return AreConfusable(named, effect); });
  });
}

bool Holds(const Direction& interval, double direction_deg) {
  const double distance = std::remainder(interval.towards_deg - direction_deg, 360.0);
  const double opposite = std::remainder(distance + 180.0, 360.0);
  return std::abs(distance) <= interval.half_width_deg ||
         (interval.or_opposite && std::abs(opposite) <= interval.half_width_deg);
}

bool IsUnknown(const Cause& cause) {
  return cause.effects.contains(std::string(kUnknown));
}

std::size_t ClassSize(const Cause& cause) {
  return 1 + cause.indistinguishable.size() + cause.indistinguishable_sets.size();
}

Figures FiguresOf(const std::vector<Scored>& cases) {
  Figures figures;
  for (const Scored& scored : cases) {
    const std::string& kind = scored.label.kind;
    if (kind == "nominal") CountNominal(figures, scored);
    if (kind == "single") CountNaming(figures.all, scored);
    if (kind == "single" && Detectability(scored) >= kDetectable) {
      CountNaming(figures.detectable, scored);
    }
    if (kind == "single" && Detectability(scored, scored.label.sizes) >= kDetectable) {
      CountNaming(figures.detectable_as_it_is, scored);
    }
    CountLeftOut(figures, scored);
    if (kind == "pair") CountPair(figures, scored);
    if (kind == "outside") CountOutside(figures, scored);
    CountDirections(figures, scored);
    CountByEffect(figures, scored);

    const Report& report = scored.report;
    const bool hit = ClassHit(scored);
    if (const Cause* first = FirstCause(report)) {
      figures.forecasts.push_back({first->probability, hit});
    }
    if (hit && kind != "outside" && report.closure) figures.closures.push_back(*report.closure);
    if (report.closure && report.realised) {
      const double error = std::abs(*report.closure - *report.realised);
      figures.closure_errors.push_back(error);
      if (IsSure(report)) figures.named_closure_errors.push_back(error);
    }
  }
  return figures;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace blind::score
