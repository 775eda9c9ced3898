#include "telltale/client/cli/quality_table.hpp"

#include <algorithm>
#include <utility>

#include "telltale/client/cli/duration_text.hpp"
#include "telltale/client/cli/table.hpp"

namespace telltale {
namespace {

constexpr std::size_t kLongestId = 18;

std::string VerdictText(QualityVerdict verdict) {
  return verdict == QualityVerdict::kUnknown ? "?" : std::string(Name(verdict));
}

std::string RejectedOf(const std::string& subject, const std::vector<RejectEntry>& rejected) {
  std::string text;
  for (const RejectEntry& entry : rejected) {
    text += (text.empty() ? "" : ", ") + entry.channel + ' ' + std::to_string(entry.count) + ' ' +
            entry.reason;
  }
  return text.empty() ? "" : Wrapped(subject + " rejected: " + text);
}

bool IsShown(const Quality& quality, const QualityView& view) {
  if (quality.vehicle_id == kUnattributed) return false;
  if (!view.match.empty() && quality.vehicle_id.find(view.match) == std::string::npos) return false;
  return view.verdicts.empty() ||
         std::ranges::find(view.verdicts, quality.verdict) != view.verdicts.end();
}

/// Less comes first.
double Rank(const Quality& quality, QualityOrder order) {
  switch (order) {
    case QualityOrder::kUrgency: return SeverityRank(quality.verdict);
    case QualityOrder::kError: return -quality.prediction_error;
    case QualityOrder::kFill: return quality.window_fill;
    case QualityOrder::kAge: return quality.model_revision ? -quality.model_age_s : 0.0;
    case QualityOrder::kId: break;
  }
  return 0.0;
}

std::string Shortened(const std::string& id) {
  return id.size() <= kLongestId ? id : id.substr(0, kLongestId - 1) + "…";
}

std::string RateText(double rate_hz) {
  return Fixed(rate_hz, rate_hz < 9.95 ? 1 : 0);
}

/// "5.0/10/10": fixes, headings, thruster commands a second.
std::string RateText(const Quality& quality) {
  return RateText(quality.gnss_rate_hz) + '/' + RateText(quality.heading_rate_hz) + '/' +
         RateText(quality.thrusters_rate_hz);
}

std::string Percent(double share) {
  return Fixed(100.0 * share, 0);
}

void AddVehicle(const Quality& quality, Table& table) {
  const bool modelled = quality.model_revision.has_value();
  table.AddRow({Shortened(quality.vehicle_id), VerdictText(quality.verdict),
                Percent(quality.window_fill), RateText(quality), Percent(quality.loss_share),
                Percent(quality.reject_share),
                modelled ? std::to_string(*quality.model_revision) : "none",
                modelled ? DurationText(quality.model_age_s) : "",
                quality.prediction_error > 0.0 ? Fixed(quality.prediction_error, 2) : ""});
}

/// "6 boats: 1 ERROR, 1 WARN, 4 OK".
std::string CountText(const std::map<std::string, Quality>& fleet) {
  std::map<int, std::pair<std::string, std::size_t>> counts;
  std::size_t total = 0;
  for (const auto& [id, quality] : fleet) {
    if (id == kUnattributed) continue;
    auto& count = counts[SeverityRank(quality.verdict)];
    count.first = VerdictText(quality.verdict);
    ++count.second;
    ++total;
  }
  std::string text = Counted(total, "boat", "boats");
  for (const auto& [urgency, count] : counts) {
    text += (urgency == counts.begin()->first ? ": " : ", ") + std::to_string(count.second) + ' ' +
            count.first;
  }
  return text + "\n\n";
}

std::string ReasonsText(const Quality& quality) {
  std::string text;
  for (const QualityReason& reason : quality.reasons) {
    text += Wrapped(std::string(Name(reason.verdict)) + ' ' + reason.text, "  ");
  }
  return text;
}

std::string Notes(const std::vector<Quality>& shown) {
  std::string notes;
  for (const Quality& quality : shown) {
    if (quality.reasons.empty()) continue;
    notes += '\n' + quality.vehicle_id + '\n' + ReasonsText(quality);
    if (!quality.proposal.empty()) notes += Wrapped(quality.proposal, "  ");
  }
  return notes;
}

std::string Line(const std::string& subject, const std::string& text) {
  constexpr std::size_t kSubjectWidth = 14;
  const std::string head = subject + std::string(kSubjectWidth - subject.size(), ' ');
  const std::string wrapped = Wrapped(text, std::string(kSubjectWidth, ' '), kTerminalColumns);
  return head + wrapped.substr(kSubjectWidth);
}

std::string TelemetryLines(const Quality& quality) {
  const bool has_sent = quality.accepted > 0 || !quality.rejected.empty();
  std::string text =
      Line("telemetry", RateText(quality) + " fixes/headings/commands a second; newest sample " +
                            (has_sent ? DurationText(quality.silent_s) + " ago" : "none"));
  text += Line("window", Fixed(quality.window_s, 0) + " s, " + Percent(quality.window_fill) +
                             " % of what it may hold; " + std::to_string(quality.accepted) +
                             " samples kept");
  text += Line("last minute", Percent(quality.loss_share) + " % lost, " +
                                  Percent(quality.reject_share) + " % rejected, " +
                                  Percent(quality.shed_share) + " % shed");
  text += Line("since start", std::to_string(quality.lost) + " lost; " +
                                  (quality.rejected.empty() ? "none rejected" : "rejected:"));
  for (const RejectEntry& entry : quality.rejected) {
    text += Line("", entry.channel + ' ' + entry.reason + ' ' + std::to_string(entry.count));
  }
  for (const Channel channel : kChannels) {
    const std::uint64_t shed = quality.shed[static_cast<std::size_t>(channel)];
    if (shed > 0) text += Line("", std::string(Name(channel)) + " shed " + std::to_string(shed));
  }
  return text;
}

std::string DelayText(const ChannelDelay& delay) {
  return std::string(Name(delay.channel)) + ' ' + Significant(delay.estimate_s, 2) + " [" +
         Significant(delay.lower_s, 2) + ", " + Significant(delay.upper_s, 2) +
         "] s behind the headings";
}

std::string ModelLines(const Quality& quality, double now_unix_s) {
  if (!quality.model_revision) return Line("model", "none");
  std::string text =
      Line("model", "revision " + std::to_string(*quality.model_revision) + ", " +
                        DurationText(quality.model_age_s) + " old; " +
                        std::to_string(quality.identified) + " of " +
                        std::to_string(quality.coefficients) +
                        " coefficients identified, median half width of their bounds " +
                        Percent(quality.relative_half_width) + " % of the estimate");
  if (quality.model_verdict.verdict != PromotionVerdict::kUnknown) {
    const Promotion& given = quality.model_verdict;
    text += Line("model verdict", std::string(Name(given.verdict)) +
                                      (given.reason.empty() ? "" : ": " + given.reason));
  }
  for (const ChannelDelay& delay : quality.delays) text += Line("delay", DelayText(delay));
  if (quality.prediction_error > 0.0) {
    text += Line("error now", Fixed(quality.prediction_error, 2) +
                                  " times the normal error over 5 s, changing by " +
                                  Fixed(quality.drift, 2) + " an evaluation");
  }
  if (quality.drift_since_unix_s > 0.0) {
    text += Line("drift since", DurationText(now_unix_s - quality.drift_since_unix_s) + " ago");
  }
  if (!quality.drift_untested.empty()) text += Line("no drift test", quality.drift_untested);
  return text;
}

std::string AnswerLines(const Quality& quality, double now_unix_s) {
  std::string text;
  if (quality.last_refusal) {
    text +=
        Line("last refusal", quality.last_refusal->subject + ": " + quality.last_refusal->reason +
                                 "; " + quality.last_refusal->advice);
  }
  if (!quality.diagnosis_verdict.empty()) {
    text += Line("diagnosis", quality.diagnosis_verdict + ", " +
                                  DurationText(now_unix_s - quality.diagnosed_unix_s) +
                                  " ago: " + quality.diagnosis_sentence);
  }
  if (!quality.proposal.empty()) text += Line("advice", quality.proposal);
  return text;
}

std::string IndicativeTable(const Quality& quality) {
  if (quality.indicative.empty()) return "";
  Table table({{"live estimate"},
               {"regressor"},
               {"estimate", Align::kRight},
               {"std. error", Align::kRight},
               {"unit"}});
  for (const IndicativeCoefficient& c : quality.indicative) {
    table.AddRow({std::string(Name(c.equation)), c.regressor, Significant(c.estimate, 3),
                  "±" + Significant(c.standard_error, 2), c.unit});
  }
  return "\nIndicative, by one-step least squares: no bounds.\n" + table.Render();
}

}  // namespace

std::vector<Quality> Selected(const std::map<std::string, Quality>& fleet,
                              const QualityView& view) {
  std::vector<Quality> shown;
  for (const auto& [vehicle_id, quality] : fleet) {
    if (IsShown(quality, view)) shown.push_back(quality);
  }
  std::ranges::stable_sort(shown, {}, [&](const Quality& q) { return Rank(q, view.order); });
  return shown;
}

std::string QualityTable(const std::map<std::string, Quality>& fleet, const QualityView& view) {
  const std::vector<Quality> shown = Selected(fleet, view);
  Table table({{"vehicle"},
               {"verdict"},
               {"fill %", Align::kRight},
               {"f/h/t Hz", Align::kRight},
               {"lost", Align::kRight},
               {"rej.", Align::kRight},
               {"rev.", Align::kRight},
               {"age", Align::kRight},
               {"error", Align::kRight}});
  for (const Quality& quality : shown) AddVehicle(quality, table);
  const auto unattributed = fleet.find(std::string(kUnattributed));
  std::string text = CountText(fleet) + table.Render() + Notes(shown);
  if (unattributed == fleet.end()) return text;
  return text + RejectedOf("for no vehicle here", unattributed->second.rejected);
}

std::string QualityDetail(const Quality& quality, double now_unix_s) {
  std::string text = quality.vehicle_id + "  " + VerdictText(quality.verdict) + " for " +
                     DurationText(now_unix_s - quality.verdict_since_unix_s) + '\n';
  text += ReasonsText(quality) + '\n' + TelemetryLines(quality);
  return text + ModelLines(quality, now_unix_s) + AnswerLines(quality, now_unix_s) +
         IndicativeTable(quality);
}

}  // namespace telltale
