#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telltale/core/diagnosis/diagnosis.hpp"

namespace telltale {

/// How a diagnosis is put for people, alike on a terminal and on a page.

/// "wind, current".
std::string Listed(const std::vector<std::string>& names);

std::string_view VerdictText(Verdict verdict);  ///< "Explained"

/// What the verdict claims, in a sentence.
std::string_view VerdictMeaning(Verdict verdict);

/// "along", "across", "heading": the errors that surge, sway and yaw leave.
std::string_view ChannelText(Equation channel);

std::string_view KindText(GapKind kind);  ///< "offset"

/// "FF" as "both forward".
std::string_view RegionText(PropellerRegion region);

/// "heading, FR, 0.5 to 1.0 m/s".
std::string PlaceText(const GapCell& cell);

/// The operating conditions that are shown to people, a dozen at most; report.json has them all.
std::span<const GapCell> ListedCells(const Diagnosis& diagnosis);

/// "38 more operating conditions stand out; report.json has them all."; empty where all are shown.
std::string MoreCellsText(const Diagnosis& diagnosis);

/// "testable", "masked by YAW uv", "not excited".
std::string TestabilityText(const EffectTestability& effect);

/// "port_loss 0.31", "forward 0.8 m, starboard beyond range"; empty where nothing is stated.
std::string DetectableText(const EffectTestability& effect);

/// " and the wind and waves of this recording", beside which effects would have to show; empty in
/// calm.
std::string BesideWeatherText(const Diagnosis& diagnosis);

/// "commands", "positions".
std::string_view DelayedChannelText(DelayedChannel channel);

/// "0.32 ± 0.16 s", with the half width of a 95 % interval.
std::string DelayText(const DelayDifference& delay);

/// "0.45 s", or "beyond range".
std::string DetectableText(const DelayDifference& delay);

/// "surge force, N" of component 0, 1 or 2.
std::string_view ForceText(std::size_t component);

/// "speed ahead, m/s".
std::string_view VariableText(ForceVariable variable);

/// The end of a bin, with as many decimals as its width needs.
std::string BinEndText(const ForceBin& bin, double end);

/// What an advised recording is good for: "would separate wind from current by 3.1 nats, which may
/// not suffice", or that it would show what the library lacks.
std::string PromiseText(const SeparationAdvice& advice);

/// "thruster_lag + wind", or "unknown".
std::string CauseText(const Cause& cause);

/// Why an unknown cause is as likely as it is: "Its odds, in nats: +1.8 by what effects still
/// predict of the errors that are left, -0.5 to begin with.". Terms that hardly count are left out.
std::string UnknownOddsText(const Diagnosis& diagnosis);

/// "Unknown cause, likeliest wind (60 %)", "No material gap".
std::string InfluenceText(const ReferenceInfluence& influence);

/// The gap of a reference itself against the floor of the others.
std::string OwnGapText(const ReferenceInfluence& influence);

/// What is known of an effect, its size and where it runs to before its parameters, each with a
/// name: "0.220 ± 0.030 m/s", one standard error, or "274 ± 25 deg (95 %)".
std::vector<std::pair<std::string, std::string>> EstimatesOf(const CausalEffect& effect);

/// "81 % [74, 87]", or "–" where there is no gap to close.
std::string ExcessExplainedText(const std::optional<ExcessExplained>& excess_explained);

/// What the floor rests on, in a sentence.
std::string FloorText(const Diagnosis& diagnosis);

/// When it began, counted from the start of the recording.
std::string OnsetText(const Onset& onset, double start_s);

}  // namespace telltale
