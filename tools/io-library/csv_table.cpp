// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/csv_table.hpp>

#include <thermopower/io/input_error.hpp>

#include "file_source.hpp"
#include "time_stamp.hpp"
#include "unit_words.hpp"

#include <csv.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <new>

namespace thermopower::io {
namespace {

constexpr std::size_t longest_field =
    4096;  // no number, label or column name is longer; a lost quote would swallow the file
constexpr std::size_t most_columns = 4096;
constexpr std::size_t longest_number = 512;     // with a decimal comma
constexpr std::size_t longest_comment = 65536;  // of one that may be a header row

bool is_missing(const char* text, std::size_t size) {
  return size == 0 ||
         (size == 3 && (text[0] | 0x20) == 'n' && (text[1] | 0x20) == 'a' && (text[2] | 0x20) == 'n');
}

enum class NumberFault { none, not_a_number, not_finite };

NumberFault parse_number(const char* text, std::size_t size, double& value) {
  const char* first = text;
  const char* const last = text + size;
  if (size > 1 && *first == '+' && first[1] != '-') ++first;  // from_chars knows no plus sign
  const auto [end, error] = std::from_chars(first, last, value);
  if (end != last || error == std::errc::invalid_argument) return NumberFault::not_a_number;
  if (error == std::errc::result_out_of_range) {
    // Too small is zero for every purpose here; too large is not.
    value = std::strtod(std::string(first, last).c_str(), nullptr);
    if (!(std::fabs(value) < 1.0)) return NumberFault::not_finite;
    return NumberFault::none;
  }
  return std::isfinite(value) ? NumberFault::none : NumberFault::not_finite;
}

std::string shortest(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

class Parser {
public:
  Parser(const std::string& file, const std::vector<std::string>& numeric,
         const std::vector<ColumnChoice>& choices, const CsvReading& how, bool any = false)
      : numeric_(numeric), choices_(choices), how_(how), any_(any) {
    table_.file = file;
    if (csv_init(&csv_, CSV_STRICT | CSV_STRICT_FINI | CSV_REPALL_NL) != 0) throw std::bad_alloc();
    csv_set_blk_size(&csv_, 512);
  }
  ~Parser() { csv_free(&csv_); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  void feed(const char* bytes, std::size_t size) {
    if (size == 0) return;
    if (bytes_ == 0) {
      reject_other_encodings(bytes, size);
      if (size >= 3 && std::memcmp(bytes, "\xef\xbb\xbf", 3) == 0) {
        bytes += 3;
        size -= 3;
        bytes_ += 3;
        if (size == 0) return;
      }
      choose_separator(bytes, size);
    }
    bytes_ += size;
    while (size > 0) {
      const std::size_t length = in_comment_ ? comment(bytes, size) : before_comment(bytes, size);
      last_byte_ = length > 0 ? bytes[length - 1] : last_byte_;
      bytes += length;
      size -= length;
    }
  }

  CsvTable finish() {
    if (in_comment_) end_comment();
    table_.ends_with_line_break = last_byte_ == '\n' || last_byte_ == '\r';
    at_end_ = true;
    if (csv_fini(&csv_, &Parser::on_field, &Parser::on_row, this) != 0) {
      rethrow();
      fail(
          line_ + lines_in_row_, column_name(),
          "the quote that opens this field is never closed; expected a closing '\"' before the end of the file");
    }
    rethrow();
    if (header_.empty()) fail(0, {}, "the file is empty; expected a header row with 't_s' and data rows");
    if (table_.rows == 0) fail(0, {}, "only a header row and no data; expected at least one data row");
    collect();
    return std::move(table_);
  }

private:
  // A separator that is no comma is one by being the more frequent in the first row that is no comment.
  void choose_separator(const char* bytes, std::size_t size) {
    const char* row = bytes;
    const char* const end = bytes + size;
    while (row < end && (*row == '#' || *row == '\n' || *row == '\r')) {
      const char* const next =
          static_cast<const char*>(std::memchr(row, '\n', static_cast<std::size_t>(end - row)));
      row = next == nullptr ? end : next + 1;
    }
    std::ptrdiff_t commas = 0, semicolons = 0, tabs = 0;
    bool quoted = false;
    for (; row < end && (quoted || (*row != '\n' && *row != '\r')); ++row) {
      if (*row == '"') quoted = !quoted;
      if (quoted) continue;
      commas += *row == ',';
      semicolons += *row == ';';
      tabs += *row == '\t';
    }
    if (std::max(semicolons, tabs) > commas) separator_ = semicolons >= tabs ? ';' : '\t';
    csv_set_delim(&csv_, static_cast<unsigned char>(separator_));
  }

  // Parses up to the next comment, a line that begins with '#' outside of quotes; how many bytes those were.
  std::size_t before_comment(const char* bytes, std::size_t size) {
    for (std::size_t at = 0, parsed = 0; at <= size; ++at) {
      const void* const found = at < size ? std::memchr(bytes + at, '#', size - at) : nullptr;
      at = found == nullptr ? size : static_cast<std::size_t>(static_cast<const char*>(found) - bytes);
      const char before = at > 0 ? bytes[at - 1] : last_byte_;
      if (at < size && before != '\n' && before != '\r') continue;
      parse(bytes + parsed, at - parsed);
      parsed = at;
      if (at < size && csv_.quoted == 0) {
        in_comment_ = true;
        return at;
      }
    }
    return size;
  }

  // Swallows a comment up to its line break; how many bytes those were.
  std::size_t comment(const char* bytes, std::size_t size) {
    const void* const found = std::memchr(bytes, '\n', size);
    const std::size_t length =
        found == nullptr ? size : static_cast<std::size_t>(static_cast<const char*>(found) - bytes) + 1;
    if (!header_done_ && comment_.size() < longest_comment)
      comment_.append(bytes, std::min(length, longest_comment - comment_.size()));
    if (found != nullptr) end_comment();
    return length;
  }

  // The last comment above the first row may hold the names of the columns: some programs write their header so.
  void end_comment() {
    in_comment_ = false;
    ++line_;
    if (header_done_) return;
    const std::size_t begin = comment_.find_first_not_of("# \t"), end = comment_.find_last_not_of(" \t\r\n");
    last_comment_ =
        begin == std::string::npos || end < begin ? std::string() : comment_.substr(begin, end + 1 - begin);
    comment_.clear();
  }

  void parse(const char* bytes, std::size_t size) {
    if (size == 0) return;
    const std::size_t taken = csv_parse(&csv_, bytes, size, &Parser::on_field, &Parser::on_row, this);
    rethrow();
    if (taken != size) fail_parse();
    if (csv_.entry_pos > longest_field) {
      fail(line_ + lines_in_row_, column_name(),
           csv_.quoted ? "the quote that opens this field is not closed within " +
                             std::to_string(longest_field) + " bytes; expected a closing '\"'"
                       : "field of more than " + std::to_string(longest_field) + " bytes; expected a number");
    }
  }

  enum class Kind : unsigned char { undecided, number, text, run, unused };
  struct Target {
    Kind kind = Kind::undecided;
    bool must_be_number = false;
    bool power = false;
    bool is_index = false;  // of pandas: the row's number, and no measurement
    bool unnamed = false;   // must not hold anything
    bool has_stamps = false, has_dates = false;
    std::int64_t first_ns = 0, last_ns = 0;
    ColumnChoice choice;
    std::vector<double> values;
  };

  [[noreturn]] void fail(std::size_t line, const std::string& column, const std::string& what) const {
    std::string text = table_.file;
    if (line != 0) text += ":" + std::to_string(line <= how_.lines.size() ? how_.lines[line - 1] : line);
    text += ": ";
    if (!column.empty()) text += "column '" + column + "': ";
    throw InputError(text + what);
  }

  void reject_other_encodings(const char* bytes, std::size_t size) const {
    const auto starts = [&](const char* mark, std::size_t n) {
      return size >= n && std::memcmp(bytes, mark, n) == 0;
    };
    if (starts("\xff\xfe", 2) || starts("\xfe\xff", 2))
      fail(1, {}, "UTF-16 text; expected UTF-8 (save the file as 'CSV UTF-8')");
    if (starts("PK\x03\x04", 4)) fail(1, {}, "a ZIP archive (a spreadsheet?); expected CSV text");
    if (starts("\x1f\x8b", 2)) fail(1, {}, "a gzip file; expected CSV text (unpack it first)");
    // Text has line breaks and tabs, and no other control characters, but for a stray one.
    constexpr std::size_t looked_at = 1024, stray = 3;
    const auto controls = std::count_if(bytes, bytes + std::min(size, looked_at), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
    });
    if (static_cast<std::size_t>(controls) > stray)
      fail(1, {},
           "not a CSV, MCAP or SimpleBGC capture: bytes that are not text; expected CSV text in UTF-8");
  }

  std::string column_name() const {
    if (field_ < header_.size()) return header_[field_];
    return header_.empty() || !header_done_ ? "number " + std::to_string(field_ + 1) : std::string();
  }

  // libcsv is C: an exception must not cross it, so it waits here until the parser has returned.
  static void on_field(void* text, std::size_t size, void* self) {
    Parser& parser = *static_cast<Parser*>(self);
    if (parser.error_) return;
    try {
      parser.take_field(static_cast<const char*>(text), size);
    } catch (...) {
      parser.error_ = std::current_exception();
    }
  }
  static void on_row(int terminator, void* self) {
    Parser& parser = *static_cast<Parser*>(self);
    if (parser.error_) return;
    try {
      parser.take_row(terminator);
    } catch (...) {
      parser.error_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }
  [[noreturn]] void fail_parse() {
    if (csv_error(&csv_) == CSV_EPARSE) {
      fail(line_ + lines_in_row_, column_name(),
           "a quote inside a field; expected quotes only around a whole field, doubled inside it");
    }
    throw std::bad_alloc();
  }

  void take_field(const char* text, std::size_t size) {
    row_started_ = true;
    if (header_done_ && !first_row_done_) {
      if (size > longest_field || field_ > most_columns)
        fail(line_, column_name(), "a field or a row of this size; expected numbers");
      first_row_.emplace_back(text, size);
    } else if (header_done_) {
      take_value(text, size);
    } else {
      take_name(text, size);
    }
    lines_in_row_ += static_cast<std::size_t>(std::count(text, text + size, '\n'));
    ++field_;
  }

  void take_name(const char* text, std::size_t size) {
    if (std::memchr(text, 0, size) != nullptr)
      fail(1, {}, "a byte 0x00 in the header row; expected CSV text");
    if (size > longest_field || field_ >= most_columns)
      fail(1, {}, "a header row of this size; expected at most 4096 names");
    header_.emplace_back(text, size);
  }

  // What a header row must be: names, one for each column, no two the same.
  void check_names() {
    if (has_numbers_only())
      fail(
          line_, {},
          "the first row holds numbers only: the header row is missing; expected names of columns above it, such as "
          "t_s,power_param,ambient_C,motor_C");
    for (std::size_t i = 0; i < header_.size(); ++i) {
      if (header_[i].empty() || header_[i] == "Unnamed: 0") {
        const bool is_index = i == 0 && header_.size() > 1 &&
                              std::find(header_.begin(), header_.end(), "index") == header_.end();
        (is_index ? index_ : unnamed_).push_back(i);
        if (is_index) header_[i] = "index";
        continue;
      }
      const auto end = header_.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(header_.begin(), end, header_[i]) != end)
        fail(1, {},
             "column " + excerpt(header_[i]) + " appears twice in the header row; expected distinct names");
    }
  }

  // Whether cells are missing or numbers, and some are: no names.
  bool has_numbers_only() const {
    bool any = false;
    for (const std::string& cell : header_) {
      std::string text = cell;
      if (separator_ != ',') std::replace(text.begin(), text.end(), ',', '.');
      double number = 0.0;
      if (is_missing(text.data(), text.size())) continue;
      if (parse_number(text.data(), text.size(), number) != NumberFault::none) return false;
      any = true;
    }
    return any;
  }

  // Gives the columns the names that were chosen for them.
  void choose_columns() {
    names_ = header_;
    std::vector<bool> chosen(header_.size(), false);
    for (const auto& choice : choices_) {
      const auto found = std::find(header_.begin(), header_.end(), choice.header);
      if (found == header_.end())
        fail(1, {},
             "no column " + excerpt(choice.header) + " in the header row (asked for as " + choice.name +
                 "); found " + header_list());
      const auto at = static_cast<std::size_t>(found - header_.begin());
      if (chosen[at]) fail(1, header_[at], "is asked for twice; expected one name for each column");
      chosen[at] = true;
      names_[at] = choice.name;
      targets_[at].choice = choice;
    }
    for (const std::size_t at : index_)
      if (!chosen[at] && !any_) targets_[at].kind = Kind::unused;
    for (const std::size_t at : index_) targets_[at].is_index = true;
    for (const std::size_t at : unnamed_) {
      targets_[at].kind = Kind::unused;
      targets_[at].unnamed = true;
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto same = [&](const ColumnChoice& choice) { return choice.name == names_[i]; };
      if (!chosen[i] && std::any_of(choices_.begin(), choices_.end(), same)) {
        targets_[i].kind = Kind::unused;
        names_[i].clear();
      }
    }
  }

  std::string header_list() const {
    std::string found;
    for (const auto& name : header_) {
      if (found.size() < 120) found += (found.empty() ? "" : ", ") + excerpt(name);
    }
    return found;
  }

  // Numbers in the place of names: the names are those of the comment above, or nowhere.
  bool take_names_from_comment() {
    double number = 0.0;
    for (const std::string& cell : header_)
      if (parse_cell(cell.data(), cell.size(), number) != NumberFault::none) return false;
    std::vector<std::string> names(1);
    for (const char one : last_comment_) {
      if (one == separator_) names.emplace_back();
      else names.back() += one;
    }
    for (std::string& name : names) {
      const std::size_t begin = name.find_first_not_of(" \t\""), end = name.find_last_not_of(" \t\"");
      name = begin == std::string::npos ? std::string() : name.substr(begin, end + 1 - begin);
    }
    if (names.size() != header_.size()) return false;
    first_row_ = std::move(header_);
    header_.clear();
    for (field_ = 0; field_ < names.size(); ++field_) take_name(names[field_].data(), names[field_].size());
    return true;
  }

  void end_header() {
    const bool names_above = take_names_from_comment();
    check_names();
    header_done_ = true;
    targets_.resize(header_.size());
    choose_columns();
    for (std::size_t i = 0; i < header_.size(); ++i) {
      Target& target = targets_[i];
      if (target.kind == Kind::unused || any_) continue;
      target.kind = names_[i] == "run" ? Kind::run : Kind::undecided;
      target.must_be_number = std::find(numeric_.begin(), numeric_.end(), names_[i]) != numeric_.end();
      target.power = names_[i] == "power_param";
      if (names_[i] == "t_s") time_ = i;
      if (names_[i] == "run") run_ = i;
    }
    if (time_ != none && how_.rows_per_s > 0.0)
      fail(
          1, "t_s",
          "is in the file; a rate of rows is for a file without time: leave --rate out, or give that column another name");
    if (time_ == none && !any_ && how_.rows_per_s <= 0.0) {
      const bool other_separator = header_.size() == 1 && header_[0].find_first_of(" |") != std::string::npos;
      fail(
          1, {},
          "no column 't_s' (time in seconds) in the header row; found " + header_list() +
              (other_separator
                   ? "; expected columns separated by commas, semicolons or tabs"
                   : "; --column t_s=HEADER says which one it is, and --rate HZ that there is none and so many rows are a second"));
    }
    if (!names_above) return;
    first_row_done_ = true;
    for (field_ = 0; field_ < first_row_.size(); ++field_)
      take_value(first_row_[field_].data(), first_row_[field_].size());
    end_data_row('\n');
  }

  // A number of this file: where columns are not separated by commas, a comma may be the decimal point. One file
  // has one kind, or a thousands separator would change a number a thousandfold.
  NumberFault parse_cell(const char* text, std::size_t size, double& value) {
    if (separator_ == ',') return parse_number(text, size, value);
    const void* const comma = std::memchr(text, ',', size);
    const bool point = std::memchr(text, '.', size) != nullptr;
    if (comma == nullptr) {
      const NumberFault fault = parse_number(text, size, value);
      if (point && fault == NumberFault::none) expect_one_kind(point_line_, comma_line_, text, size);
      return fault;
    }
    if (point || size > longest_number) return NumberFault::not_a_number;
    char copy[longest_number];
    std::memcpy(copy, text, size);
    copy[static_cast<const char*>(comma) - text] = '.';
    const NumberFault fault = parse_number(copy, size, value);
    if (fault == NumberFault::none) expect_one_kind(comma_line_, point_line_, text, size);
    return fault;
  }

  void expect_one_kind(std::size_t& mine, const std::size_t& other, const char* text,
                       std::size_t size) const {
    if (mine == 0) mine = line_ + lines_in_row_;
    if (other != 0)
      fail(line_ + lines_in_row_, column_name(),
           excerpt(text, size) + " has another decimal separator than line " + std::to_string(other) +
               "; expected points or commas throughout");
  }

  // What a cell that is no number seems to be, and what to do about it.
  std::string in_place_of_number(const char* text, std::size_t size) const {
    std::string word(text, std::min<std::size_t>(size, 64));
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const bool any_digit = std::any_of(word.begin(), word.end(), is_digit);
    if (field_ == time_ && any_digit && is_digit(word[0]) &&
        (word.find(':') != std::string::npos || std::count(word.begin(), word.end(), '-') == 2 ||
         std::count(word.begin(), word.end(), '/') == 2))
      return " is a date or a time of day that cannot be read without doubt; expected seconds since the start, such as 0.25, or a date "
             "such as 2026-01-31T12:34:56.789 (in Python: pandas.to_datetime(stamp).isoformat())";
    const std::string expected =
        " is not a number; expected a decimal number, or an empty cell or nan for a missing sample";
    if (table_.rows > 0 || any_digit) return expected;
    return unit_word(word).dimension == Dimension::none
               ? expected
               : " is not a number: this looks like a row of units; delete it (--column NAME=HEADER:UNIT says a unit)";
  }

  // Whether the first row below the header holds units in the place of numbers.
  bool is_row_of_units() const {
    std::size_t units = 0;
    for (const std::string& cell : first_row_) {
      double value = 0.0;
      if (is_missing(cell.data(), cell.size()) || cell == "1") continue;
      if (parse_number(cell.data(), cell.size(), value) != NumberFault::not_a_number) return false;
      constexpr std::size_t longest_unit = 16;
      if (cell.size() > longest_unit) return false;
      units += unit_word(cell).dimension == Dimension::none ? 0 : 1;
    }
    const auto filled = static_cast<std::size_t>(std::count_if(
        first_row_.begin(), first_row_.end(), [](const std::string& cell) { return !cell.empty(); }));
    return units > 0 && 2 * units >= filled && first_row_.size() == header_.size();
  }

  // A column whose choice says no unit is in the unit that the row of units says.
  void take_units() {
    units_ = first_row_;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      ColumnChoice& choice = targets_[i].choice;
      if (any_ || !targets_[i].must_be_number || !choice.unit.empty()) continue;
      const UnitWord unit = unit_word(units_[i]);
      if (unit.dimension == Dimension::none || units_[i] == "-") continue;
      const std::vector<std::string> known = units_of(names_[i]);
      if (std::find(known.begin(), known.end(), unit.unit) == known.end())
        fail(line_, header_[i],
             "the row of units says " + excerpt(units_[i]) + ", which is not a unit of " + names_[i] +
                 "; --column " + names_[i] + "=" + header_[i] + ":" + known.front() + " says another one");
      choice = parse_column_choice(names_[i] + "=" + header_[i] + ":" + unit.unit);
    }
  }

  void take_first_row(int terminator) {
    first_row_done_ = true;
    if (is_row_of_units()) {
      take_units();
      return;
    }
    const std::size_t fields = field_;
    for (field_ = 0; field_ < fields; ++field_)
      take_value(first_row_[field_].data(), first_row_[field_].size());
    end_data_row(terminator);
  }

  /// Which unit a power may be in that is too large, and how to say so.
  std::string other_power(double value) const {
    std::string units;
    for (const char* full : {"1023", "4095", "65535"})
      if (value > 0.0 && value <= std::atof(full)) units += (units.empty() ? "" : ", ") + std::string(full);
    if (units.empty()) return {};
    return "; where full power is another word, --column power_param=" + header_[field_] + ":" +
           units.substr(0, units.find(',')) +
           (units.find(',') == std::string::npos ? "" : " (known: " + units + ")");
  }

  void take_value(const char* text, std::size_t size) {
    if (field_ >= targets_.size())
      return;  // counted, and refused at the end of the row, where the count is known
    Target& target = targets_[field_];
    if (target.kind == Kind::run) {
      label_.assign(text, std::min(size, longest_field));
      return;
    }
    if (target.unnamed && size > 0)
      fail(line_, {},
           "column number " + std::to_string(field_ + 1) + " has no name and holds " + excerpt(text, size) +
               "; expected a name for each column");
    if (target.kind == Kind::text || target.kind == Kind::unused) return;
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!is_missing(text, size)) {
      const NumberFault fault = parse_cell(text, size, value);
      if (fault == NumberFault::not_a_number && (field_ == time_ || any_) && take_stamp(target, text, size))
        return;
      if (fault == NumberFault::not_a_number) {
        if (target.kind == Kind::undecided && !target.must_be_number &&
            std::memchr(text, 0, size) == nullptr) {
          target.kind = Kind::text;
          target.values = {};
          return;
        }
        fail(line_ + lines_in_row_, header_[field_], excerpt(text, size) + in_place_of_number(text, size));
      }
      if (fault == NumberFault::not_finite) {
        fail(line_ + lines_in_row_, header_[field_],
             excerpt(text, size) +
                 " is not finite; expected a finite number, or an empty cell or "
                 "nan for a missing sample");
      }
      if (target.has_stamps)
        fail(line_, header_[field_],
             excerpt(text, size) + " follows dates or times of day; expected one of these in every row");
      target.kind = Kind::number;
      value = value_of(target.choice, value);
      if (target.power && !(value >= 0.0 && value <= 255.0)) {
        fail(line_ + lines_in_row_, header_[field_],
             excerpt(text, size) + " is outside its range; expected 0..255" + other_power(value));
      }
    } else if (field_ == time_ && !any_) {
      fail(line_ + lines_in_row_, header_[field_],
           "time is missing; expected a time in seconds in every row");
    }
    target.values.push_back(value);
  }

  // Dates and times of day become seconds since the first. One column has one kind of them.
  bool take_stamp(Target& target, const char* text, std::size_t size) const {
    if (target.kind == Kind::number && !target.has_stamps) return false;
    const auto stamp = parse_time_stamp(text, size);
    if (!stamp || (target.has_stamps && stamp->has_date != target.has_dates)) return false;
    if (!target.choice.unit.empty() && target.choice.unit != "s")
      fail(
          line_, header_[field_],
          "holds dates or times of day, which have no unit; expected --column t_s=" + header_[field_] + ":s");
    constexpr std::int64_t day_ns = 86400000000000;
    std::int64_t ns = stamp->ns;
    if (!target.has_stamps) target.first_ns = target.last_ns = ns;
    // Past midnight.
    if (!stamp->has_date)
      while (ns + day_ns / 2 < target.last_ns) ns += day_ns;
    target.has_stamps = true;
    target.has_dates = stamp->has_date;
    target.kind = Kind::number;
    target.last_ns = ns;
    target.values.push_back(static_cast<double>(ns - target.first_ns) / 1e9);
    return true;
  }

  void take_row(int terminator) {
    // With CSV_REPALL_NL a CRLF is reported twice; the LF that follows a CR ends nothing.
    const bool second_half = terminator == '\n' && last_terminator_ == '\r' && !row_started_;
    last_terminator_ = terminator;
    if (second_half) return;
    if (row_started_) {
      if (!header_done_) {
        end_header();
      } else if (!first_row_done_) {
        take_first_row(terminator);
      } else {
        end_data_row(terminator);
      }
    }
    line_ += 1 + lines_in_row_;
    lines_in_row_ = 0;
    field_ = 0;
    row_started_ = false;
  }

  void end_data_row(int terminator) {
    if (field_ != header_.size()) {
      const std::string count = std::to_string(field_) + (field_ == 1 ? " field" : " fields");
      const std::string expected = "expected " + std::to_string(header_.size()) + " as in the header row";
      const bool cut_off = at_end_ && terminator == -1 && field_ < header_.size();
      fail(line_, field_ < header_.size() ? header_[field_] : std::string(),
           cut_off ? "the file ends inside this row, after " + count + "; " + expected +
                         " (was the file cut off?)"
                   : count + " in this row; " + expected);
    }
    const std::size_t row = table_.rows;
    if (any_) {
      ++table_.rows;
      return;
    }
    const bool new_run = row == 0 || (run_ != none && label_ != table_.run_labels.back());
    if (time_ == none)
      made_time_.push_back(new_run ? 0.0
                                   : static_cast<double>(row - table_.run_begin.back()) / how_.rows_per_s);
    const std::vector<double>& time = time_ == none ? made_time_ : targets_[time_].values;
    if (new_run) {
      table_.run_begin.push_back(row);
      table_.run_labels.push_back(label_);
      table_.line_of_run.push_back(line_);
    } else if (!(time[row] > time[row - 1])) {
      if (repeats_the_row_before(row)) {
        table_.repeated.push_back({row, line_});
        for (Target& target : targets_)
          if (target.values.size() > row) target.values.pop_back();
        return;
      }
      if (!is_restart(time, row))
        fail(line_, "t_s",
             "time " + shortest(time[row]) + " s follows " + shortest(time[row - 1]) +
                 " s; expected strictly increasing time inside a run: " + what_is_out_of_order(time, row));
      table_.restarts.push_back({row, line_});
      table_.run_begin.push_back(row);
      table_.run_labels.push_back(label_);
      table_.line_of_run.push_back(line_);
    }
    ++table_.rows;
  }

  // Whether all cells of a row are those of the row before it, empty ones included.
  bool repeats_the_row_before(std::size_t row) const {
    return std::all_of(targets_.begin(), targets_.end(), [row](const Target& one) {
      if (one.values.size() <= row) return true;  // text, or a label
      const double now = one.values[row], before = one.values[row - 1];
      return now == before || (std::isnan(now) && std::isnan(before));
    });
  }

  // Whether time falls back to where the run began, or before that, after it has gone on for some rows.
  bool is_restart(const std::vector<double>& time, std::size_t row) const {
    constexpr std::size_t least_rows = 8;
    constexpr double near = 0.1;  // of how long the run has lasted
    const std::size_t begin = table_.run_begin.back();
    return row - begin >= least_rows && time[row] - time[begin] < near * (time[row - 1] - time[begin]);
  }

  // What to do about time that does not increase.
  std::string what_is_out_of_order(const std::vector<double>& time, std::size_t row) const {
    if (time[row] == time[row - 1])
      return "two rows of one time that differ; keep one of them, or write the stamps with more digits";
    const bool swapped = row >= table_.run_begin.back() + 2 && time[row] > time[row - 2];
    return std::string(swapped ? "this row belongs before the one above it; sort the rows by time"
                               : "time goes back; sort the rows by time if they were mixed up") +
           ", or, where a recording begins anew here, give each its own label in a column 'run'";
  }

  void collect() {
    if (time_ == none && !any_) table_.columns.push_back({"t_s", std::move(made_time_)});
    for (std::size_t i = 0; i < header_.size(); ++i) {
      Target& target = targets_[i];
      if (target.kind == Kind::text) table_.ignored_text.push_back(header_[i]);
      if (target.kind != Kind::number && target.kind != Kind::undecided) continue;
      if (target.has_stamps) table_.stamps.push_back(names_[i]);
      table_.columns.push_back({names_[i], std::move(target.values)});
      if (!units_.empty()) table_.units.push_back(units_[i]);
    }
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  const std::vector<std::string>& numeric_;
  const std::vector<ColumnChoice>& choices_;
  const CsvReading& how_;
  bool any_;  ///< no column has a meaning
  CsvTable table_;
  csv_parser csv_{};
  std::exception_ptr error_;
  std::vector<std::string> header_;  ///< as in the file
  std::vector<std::string> names_;   ///< as in the format; empty: left out
  std::vector<Target> targets_;
  std::string label_;
  std::size_t line_ = 1;
  std::size_t lines_in_row_ = 0;
  std::size_t field_ = 0;
  std::size_t time_ = none;
  std::size_t run_ = none;
  std::size_t bytes_ = 0;
  int last_terminator_ = 0;
  char last_byte_ = '\n';
  bool header_done_ = false;
  bool row_started_ = false;
  bool at_end_ = false;
  char separator_ = ',';
  bool in_comment_ = false;
  std::string comment_, last_comment_;        ///< as it is read, and the last one above the first row
  std::vector<std::string> first_row_;        ///< below the header: it may hold units
  std::vector<std::string> units_;            ///< of all columns, where a row of units was there
  std::vector<std::size_t> index_, unnamed_;  ///< columns without a name
  std::vector<double> made_time_;             ///< of a file without time
  bool first_row_done_ = false;
  std::size_t point_line_ = 0, comma_line_ = 0;  ///< where each decimal separator was seen first; 0: not yet
};

}  // namespace

namespace {

CsvTable parse_bytes(Parser& parser, const char* bytes, std::size_t size) {
  constexpr std::size_t block =
      65536;  // bounded, so that a runaway field is noticed before it fills the memory
  for (std::size_t at = 0; at < size; at += block) parser.feed(bytes + at, std::min(block, size - at));
  return parser.finish();
}

CsvTable read_file(const std::string& path, const std::vector<std::string>& numeric,
                   const std::vector<ColumnChoice>& choices, const CsvReading& how, bool any) {
  const OpenFile file = open_input(path, "a CSV file");
  Parser parser(path == "-" ? "standard input" : path, numeric, choices, how, any);
  std::vector<char> block(65536);
  for (;;) {
    const std::size_t got = std::fread(block.data(), 1, block.size(), file.get());
    parser.feed(block.data(), got);
    if (got < block.size()) {
      if (std::ferror(file.get())) throw InputError(path + ": cannot be read: " + std::strerror(errno));
      break;
    }
  }
  return parser.finish();
}

}  // namespace

CsvTable parse_csv(const std::string& name, const char* bytes, std::size_t size,
                   const std::vector<std::string>& numeric, const std::vector<ColumnChoice>& choices,
                   const CsvReading& how) {
  Parser parser(name, numeric, choices, how);
  return parse_bytes(parser, bytes, size);
}

CsvTable read_csv(const std::string& path, const std::vector<std::string>& numeric,
                  const std::vector<ColumnChoice>& choices, const CsvReading& how) {
  return read_file(path, numeric, choices, how, false);
}

CsvTable parse_any_csv(const std::string& name, const char* bytes, std::size_t size) {
  const std::vector<std::string> numeric;
  const std::vector<ColumnChoice> choices;
  const CsvReading how;
  Parser parser(name, numeric, choices, how, true);
  return parse_bytes(parser, bytes, size);
}

CsvTable read_any_csv(const std::string& path) { return read_file(path, {}, {}, {}, true); }

}  // namespace thermopower::io
