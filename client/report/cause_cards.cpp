#include <algorithm>

#include "telltale/client/report/diagnosis_text.hpp"
#include "telltale/client/report/number_text.hpp"
#include "telltale/client/report/pictures.hpp"
#include "telltale/client/report/plot.hpp"

namespace telltale {
namespace {

constexpr double kLikely = 0.05;  ///< a cause below is named without a card of its own

Markup ProbabilityBar(double probability) {
  const Axis x{0.0, 1.0, 0.0, 100.0};
  return Element("svg",
                 {{"class", "probability"},
                  {"viewBox", "0 0 100 6"},
                  {"preserveAspectRatio", "none"},
                  {"role", "img"},
                  {"aria-label", "probability " + ShareText(probability)}},
                 RectangleShape({0.0, 0.0}, {100.0, 6.0}, "track") +
                     RectangleShape({0.0, 0.0}, {x(probability), 6.0}, "ink-bar"));
}

Markup ExcessExplainedPlot(const ExcessExplained& excess_explained) {
  constexpr double kWidth = 260.0;
  constexpr double kBaseline = 14.0;
  const double low = std::clamp(excess_explained.interval.lower, -1.0, 0.0);
  const double high = std::clamp(excess_explained.interval.upper, 1.0, 1.5);
  const Axis x{low, high, 18.0, kWidth - 26.0};
  Markup shapes = LineShape({x(low), kBaseline}, {x(high), kBaseline}, "grid");
  for (const double share : {0.0, 0.5, 1.0}) {
    shapes += LineShape({x(share), kBaseline - 5.0}, {x(share), kBaseline + 5.0}, "grid");
    shapes += LabelShape({x(share), kBaseline + 24.0}, ShareText(share), Anchor::kMiddle);
  }
  shapes += LineShape({x(excess_explained.interval.lower), kBaseline},
                      {x(excess_explained.interval.upper), kBaseline}, "whisker");
  shapes += CircleShape({x(excess_explained.share), kBaseline}, 6.0, "whisker-dot");
  return Picture({kWidth, 44.0}, "whiskers",
                 "explains " + ExcessExplainedText(excess_explained) + " of the excess error",
                 shapes);
}

Markup ParameterList(const CausalEffect& effect) {
  Markup items;
  for (const auto& [name, estimate] : EstimatesOf(effect)) {
    items += Element("dt", {}, JoinedName(name));
    items += Element("dd", {}, Words(estimate));
  }
  return items.Text().empty() ? items : Element("dl", {}, items);
}

Markup EffectPart(const CausalEffect& effect, bool several) {
  std::string text = effect.sentence.empty() ? effect.effect : effect.sentence;
  if (several) text += " (" + ShareText(effect.shapley_share) + " of what these explain)";
  return Styled("p", "says", Words(text)) + ParameterList(effect);
}

Markup IndistinguishableText(const Cause& cause) {
  if (cause.indistinguishable.empty()) return {};
  return Styled(
      "p", "tied",
      Words("This recording cannot separate it from " + Listed(cause.indistinguishable) + "."));
}

Markup CauseCard(const Cause& cause, const Diagnosis& diagnosis) {
  Markup card = Styled("header", "",
                       Styled("h3", "", JoinedName(CauseText(cause))) +
                           Styled("b", "share", Words(ShareText(cause.probability)))) +
                ProbabilityBar(cause.probability);
  if (cause.effects.empty()) {
    card += Styled("p", "says", Words("Something that the library of effects lacks."));
    const std::string odds = UnknownOddsText(diagnosis);
    if (!odds.empty()) card += Styled("p", "soft", Words(odds));
  }
  for (const CausalEffect& effect : cause.effects) {
    card += EffectPart(effect, cause.effects.size() > 1);
  }
  card += IndistinguishableText(cause);
  if (cause.excess_explained) {
    card += Styled("p", "soft",
                   Words("Explains " + ExcessExplainedText(cause.excess_explained) +
                         " of the excess error")) +
            ExcessExplainedPlot(*cause.excess_explained);
  }
  return Styled("article", "card", card);
}

}  // namespace

Markup CauseCards(const Diagnosis& diagnosis) {
  if (diagnosis.causes.empty()) {
    return Nothing(diagnosis.verdict == Verdict::kInsufficientData
                       ? "The recording is too little to ask for a cause."
                       : "There is no gap that would ask for a cause.");
  }
  Markup cards;
  std::vector<std::string> unlikely;
  for (const Cause& cause : diagnosis.causes) {
    if (cause.probability >= kLikely) {
      cards += CauseCard(cause, diagnosis);
    } else {
      unlikely.push_back(CauseText(cause) + ' ' + ShareText(cause.probability));
    }
  }
  Markup all = Styled("div", "cards", cards);
  if (unlikely.empty()) return all;
  return all + Styled("p", "soft unlikely", Words("Unlikely: " + Listed(unlikely) + '.'));
}

}  // namespace telltale
