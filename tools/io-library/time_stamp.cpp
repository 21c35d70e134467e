// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "time_stamp.hpp"

namespace thermopower::io {
namespace {

constexpr std::int64_t second_ns = 1000000000, minute_s = 60, hour_s = 3600, day_s = 86400;

/// Reads on through a text.
class Cursor {
public:
  Cursor(const char* text, std::size_t size) : at_(text), end_(text + size) {}

  bool done() const { return at_ == end_; }
  char peek() const { return done() ? '\0' : *at_; }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  // A whole number of so many digits.
  std::optional<std::int64_t> digits(int least, int most) {
    std::int64_t value = 0;
    int count = 0;
    for (; count < most && peek() >= '0' && peek() <= '9'; ++count) value = 10 * value + (*at_++ - '0');
    if (count < least) return std::nullopt;
    return value;
  }
  // Digits behind a decimal point, as nanoseconds.
  std::optional<std::int64_t> fraction_ns() {
    std::int64_t value = 0, unit = second_ns / 10;
    bool any = false;
    for (; peek() >= '0' && peek() <= '9'; unit /= 10, any = true) value += unit * (*at_++ - '0');
    if (!any) return std::nullopt;
    return value;
  }

private:
  const char* at_;
  const char* end_;
};

// Days since 1970 of the Gregorian calendar, after Howard Hinnant's days_from_civil.
std::int64_t days_since_1970(std::int64_t year, std::int64_t month, std::int64_t day) {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = year / 400, of_era = year - 400 * era;
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return 146097 * era + 365 * of_era + of_era / 4 - of_era / 100 + of_year - 719468;
}

// Year, month, day with one separator, or day.month.year.
std::optional<std::int64_t> date_days(Cursor& in, std::int64_t first, int first_digits) {
  const char separator = in.peek();
  if (separator != '-' && separator != '/' && separator != '.') return std::nullopt;
  in.take(separator);
  const bool year_first = first_digits == 4;
  if (!year_first && separator != '.') return std::nullopt;
  const auto month = in.digits(1, 2);
  if (!month || !in.take(separator)) return std::nullopt;
  const auto last = in.digits(year_first ? 1 : 4, year_first ? 2 : 4);
  if (!last) return std::nullopt;
  const std::int64_t year = year_first ? first : *last, day = year_first ? *last : first;
  if (year < 1900 || year > 2200 || *month < 1 || *month > 12 || day < 1 || day > 31) return std::nullopt;
  return days_since_1970(year, *month, day);
}

// Hours, minutes, and seconds where they are there.
std::optional<std::int64_t> clock_ns(Cursor& in, std::int64_t hour) {
  if (!in.take(':')) return std::nullopt;
  const auto minute = in.digits(2, 2);
  if (!minute || hour > 23 || *minute > 59) return std::nullopt;
  std::int64_t ns = (hour * hour_s + *minute * minute_s) * second_ns;
  if (!in.take(':')) return ns;
  const auto second = in.digits(2, 2);
  if (!second || *second > 60) return std::nullopt;
  ns += *second * second_ns;
  if (in.take('.') || in.take(',')) {
    const auto fraction = in.fraction_ns();
    if (!fraction) return std::nullopt;
    ns += *fraction;
  }
  return ns;
}

// `Z`, `UTC`, `+01:00`, `+0100`, `+01`, or nothing.
std::optional<std::int64_t> zone_ns(Cursor& in) {
  in.take(' ');
  if (in.take('Z')) return 0;
  if (in.take('U')) return in.take('T') && in.take('C') ? std::optional<std::int64_t>(0) : std::nullopt;
  const bool minus = in.peek() == '-';
  if (!in.take('+') && !in.take('-')) return 0;
  const auto hour = in.digits(2, 2);
  if (!hour) return std::nullopt;
  in.take(':');
  const std::int64_t minute = in.done() ? 0 : in.digits(2, 2).value_or(-1);
  if (*hour > 14 || minute < 0 || minute > 59) return std::nullopt;
  const std::int64_t ns = (*hour * hour_s + minute * minute_s) * second_ns;
  return minus ? -ns : ns;
}

}  // namespace

std::optional<TimeStamp> parse_time_stamp(const char* text, std::size_t size) {
  Cursor in(text, size);
  const char* const begin = text;
  int first_digits = 0;
  while (static_cast<std::size_t>(first_digits) < size && begin[first_digits] >= '0' &&
         begin[first_digits] <= '9')
    ++first_digits;
  if (first_digits < 1 || first_digits > 4 || first_digits == 3) return std::nullopt;
  const std::int64_t first = *in.digits(1, 4);
  TimeStamp stamp;
  if (in.peek() == ':') {
    const auto ns = first_digits <= 2 ? clock_ns(in, first) : std::nullopt;
    if (!ns || !in.done()) return std::nullopt;
    stamp.ns = *ns;
    return stamp;
  }
  const auto days = date_days(in, first, first_digits);
  if (!days) return std::nullopt;
  stamp.has_date = true;
  stamp.ns = *days * day_s * second_ns;
  if (in.done()) return stamp;
  if (!in.take('T') && !in.take(' ')) return std::nullopt;
  const auto hour = in.digits(1, 2);
  const auto ns = hour ? clock_ns(in, *hour) : std::nullopt;
  if (!ns) return std::nullopt;
  const auto zone = zone_ns(in);
  if (!zone || !in.done()) return std::nullopt;
  stamp.ns += *ns - *zone;
  return stamp;
}

}  // namespace thermopower::io
