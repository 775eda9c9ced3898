#include "telltale/client/recording/csv/iso_time.hpp"

#include <charconv>
#include <chrono>
#include <cstddef>

namespace telltale {
namespace {

/// Takes a text from front to back; what is not as expected makes Ok() false.
class TimeText {
 public:
  explicit TimeText(std::string_view text) : rest_(text) {}

  int Digits(std::size_t count) {
    int value = 0;
    ok_ = ok_ && rest_.size() >= count;
    for (std::size_t i = 0; ok_ && i < count; ++i) {
      ok_ = '0' <= rest_[i] && rest_[i] <= '9';
      value = 10 * value + (rest_[i] - '0');
    }
    if (ok_) rest_.remove_prefix(count);
    return value;
  }
  bool TakeOneOf(std::string_view characters) {
    const bool is_there = !rest_.empty() && characters.find(rest_[0]) != std::string_view::npos;
    if (is_there) rest_.remove_prefix(1);
    return is_there;
  }
  void Expect(std::string_view characters) { ok_ = TakeOneOf(characters) && ok_; }

  double Seconds() {
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(rest_.data(), rest_.data() + rest_.size(), value, std::chars_format::fixed);
    ok_ = ok_ && error == std::errc() && 0.0 <= value && value < 61.0;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  /// Seconds ahead of UTC.
  int Zone() {
    if (rest_.empty() || TakeOneOf("Z")) return 0;
    const bool is_west = rest_[0] == '-';
    Expect("+-");
    const int hours = Digits(2);
    if (!TakeOneOf(":") && rest_.empty()) return (is_west ? -3600 : 3600) * hours;
    return (is_west ? -60 : 60) * (60 * hours + Digits(2));
  }
  bool Ok() const { return ok_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace

std::optional<double> SecondsOfIsoTime(std::string_view text) {
  using std::chrono::year, std::chrono::month, std::chrono::day;
  TimeText from(text);
  const year of_year(from.Digits(4));
  from.Expect("-");
  const month of_month(static_cast<unsigned>(from.Digits(2)));
  from.Expect("-");
  const auto date = of_year / of_month / day(static_cast<unsigned>(from.Digits(2)));
  from.Expect("T ");
  const int hours = from.Digits(2);
  from.Expect(":");
  const int minutes = from.Digits(2);
  from.Expect(":");
  const double seconds = from.Seconds();
  const int zone_s = from.Zone();
  if (!from.Ok() || !date.ok() || hours > 24 || minutes > 59) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch();
  return static_cast<double>(std::chrono::seconds(days).count() + 3600 * hours + 60 * minutes -
                             zone_s) +
         seconds;
}

}  // namespace telltale
