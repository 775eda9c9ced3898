#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/grouped_error.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"

namespace telltale {
namespace {

constexpr std::size_t kMostSpeeds = 5;

using SpeedRow = std::array<GroupedError, kPropellerRegions.size()>;

struct SpeedMap {
  double step_m_s = 1.0;
  std::map<std::size_t, SpeedRow> rows;  ///< by place among the steps
  double highest = 0.0;
};

SpeedMap MapOf(const std::vector<WindowPicture>& windows) {
  std::vector<double> speeds;
  for (const WindowPicture& window : windows) speeds.push_back(window.speed_m_s);
  SpeedMap map;
  map.step_m_s = TicksUpTo(LargestFinite(speeds), kMostSpeeds)[1];
  for (const WindowPicture& window : windows) {
    if (!std::isfinite(window.speed_m_s)) continue;
    const double place = std::clamp(window.speed_m_s / map.step_m_s, 0.0, kMostSpeeds - 0.5);
    map.rows[static_cast<std::size_t>(place)][static_cast<std::size_t>(window.region)].Add(window);
  }
  for (const auto& [place, row] : map.rows) {
    for (const GroupedError& group : row) {
      map.highest = std::max(map.highest, LargestFinite({group.Before()}));
    }
  }
  return map;
}

Markup MapCell(const GroupedError& group, double highest, bool after) {
  constexpr double kDarkest = 0.6;  // ink still reads on it
  if (group.Windows() == 0) return Element("td", {{"class", "empty"}}, Words("–"));
  const double depth = Axis{0.0, highest, 0.05, kDarkest}(group.Before());
  Markup text = Styled("b", "", Words(Fixed(group.Before(), 1)));
  if (after) text += Styled("span", "", Words("→ " + Fixed(group.After(), 1)));
  text += Styled("small", "", Words("n " + std::to_string(group.Windows())));
  return Element("td", {{"style", "background: rgb(var(--heat) / " + Fixed(depth, 2) + ")"}}, text);
}

Markup RegionHeads() {
  Markup heads = Element("th", {{"scope", "col"}}, Words("m/s"));
  for (const PropellerRegion region : kPropellerRegions) {
    heads += Element("th", {{"scope", "col"}, {"title", std::string(RegionText(region))}},
                     Words(Name(region)));
  }
  return Element("thead", {}, Element("tr", {}, heads));
}

}  // namespace

Markup ErrorMap(const Diagnosis& diagnosis) {
  if (diagnosis.pictures.empty()) return Nothing("No windows were kept to sort by speed.");
  const SpeedMap map = MapOf(diagnosis.pictures);
  const bool after = HasAfter(diagnosis);
  Markup body;
  for (const auto& [place, row] : map.rows) {
    const double from = static_cast<double>(place) * map.step_m_s;
    Markup cells =
        Element("th", {{"scope", "row"}}, Words(Plain(from) + "–" + Plain(from + map.step_m_s)));
    for (const GroupedError& group : row) cells += MapCell(group, map.highest, after);
    body += Element("tr", {}, cells);
  }
  const Markup caption = Element(
      "caption", {},
      Words(
          "Error, times the normal error, by speed and propellers (port first, F forward or idle, "
          "R reverse)" +
          std::string(after ? ", before → after" : "") + "; n windows"));
  return Styled("table", "map", caption + RegionHeads() + Element("tbody", {}, body));
}

}  // namespace telltale
