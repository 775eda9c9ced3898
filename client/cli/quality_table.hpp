#pragma once

#include <map>
#include <string>
#include <vector>

#include "telltale/idl/codec/messages/quality.hpp"

namespace telltale {

/// The order of the rows; vehicles that are equal in it stand in the order of their ids.
enum class QualityOrder { kUrgency, kId, kError, kFill, kAge };

/// Which vehicles a view shows and in which order.
struct QualityView {
  QualityOrder order = QualityOrder::kUrgency;
  std::vector<QualityVerdict> verdicts;  ///< only these; empty: all
  std::string match;                     ///< only ids that hold this text
};

/// The vehicles that the view shows, in its order.
std::vector<Quality> Selected(const std::map<std::string, Quality>& fleet, const QualityView& view);

/// The fleet for people, within 80 columns: how many vehicles have which verdict, a row per
/// vehicle, under it why it is not OK, and what names no vehicle.
std::string QualityTable(const std::map<std::string, Quality>& fleet, const QualityView& view);

/// Everything about one vehicle for people, within 80 columns. `now_unix_s` is for ages.
std::string QualityDetail(const Quality& quality, double now_unix_s);

}  // namespace telltale
