// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "csv.h"

#include <cstdlib>

namespace {

constexpr int out_of_memory = 2;

bool is_blank(char one) { return one == ' ' || one == '\t'; }
bool is_line_break(char one) { return one == '\n' || one == '\r'; }

bool keep(csv_parser& parser, char one) {
  if (parser.entry_pos == parser.entry_size) {
    const std::size_t size = 2 * parser.entry_size + 128;
    char* const larger = static_cast<char*>(std::realloc(parser.entry_buf, size));
    if (larger == nullptr) return false;
    parser.entry_buf = larger;
    parser.entry_size = size;
  }
  parser.entry_buf[parser.entry_pos++] = one;
  parser.blanks = is_blank(one) ? parser.blanks + 1 : 0;
  return true;
}

void end_field(csv_parser& parser, csv_field_function on_field, void* data) {
  // Behind a closing quote there are blanks and that quote, which is not kept; in a quoted field blanks belong to it.
  const std::size_t surplus = parser.state == csv_parser::after_quote || !parser.quoted ? parser.blanks : 0;
  on_field(parser.entry_buf, parser.entry_pos - surplus, data);
  parser.state = csv_parser::before_field;
  parser.entry_pos = parser.blanks = 0;
  parser.quoted = 0;
}

void end_row(csv_parser& parser, int by, csv_row_function on_row, void* data) {
  on_row(by, data);
  parser.state = csv_parser::before_row;
}

}  // namespace

int csv_init(csv_parser* parser, unsigned char) {
  *parser = {csv_parser::before_row, 0, 0, nullptr, 0, 0, ',', 0};
  return 0;
}

void csv_free(csv_parser* parser) { std::free(parser->entry_buf); }
void csv_set_blk_size(csv_parser*, std::size_t) {}
void csv_set_delim(csv_parser* parser, unsigned char delimiter) {
  parser->delimiter = static_cast<char>(delimiter);
}
int csv_error(csv_parser* parser) { return parser->status; }

std::size_t csv_parse(csv_parser* parser, const void* bytes, std::size_t size, csv_field_function on_field,
                      csv_row_function on_row, void* data) {
  csv_parser& p = *parser;
  const char* const text = static_cast<const char*>(bytes);
  for (std::size_t at = 0; at < size; ++at) {
    const char one = text[at];
    const bool ends_field = one == p.delimiter || is_line_break(one);
    bool kept = true;
    switch (p.state) {
      case csv_parser::before_row:
      case csv_parser::before_field:
        if (one != p.delimiter && is_blank(one)) break;
        if (p.state == csv_parser::before_row && is_line_break(one)) {
          end_row(p, static_cast<unsigned char>(one), on_row, data);
        } else if (ends_field) {
          end_field(p, on_field, data);
          if (is_line_break(one)) end_row(p, static_cast<unsigned char>(one), on_row, data);
        } else {
          p.state = csv_parser::in_field;
          p.quoted = one == '"' ? 1 : 0;
          if (!p.quoted) kept = keep(p, one);
        }
        break;
      case csv_parser::in_field:
        if (one == '"' && p.quoted) {
          p.state = csv_parser::after_quote;
          p.blanks = 0;
        } else if (one == '"') {
          p.status = CSV_EPARSE;
          return at;
        } else if (ends_field && !p.quoted) {
          end_field(p, on_field, data);
          if (is_line_break(one)) end_row(p, static_cast<unsigned char>(one), on_row, data);
        } else {
          kept = keep(p, one);
        }
        break;
      case csv_parser::after_quote:
        if (ends_field) {
          end_field(p, on_field, data);
          if (is_line_break(one)) end_row(p, static_cast<unsigned char>(one), on_row, data);
        } else if (is_blank(one)) {
          kept = keep(p, one);
        } else if (one == '"' && p.blanks == 0) {
          p.state = csv_parser::in_field;
          kept = keep(p, one);
        } else {
          p.status = CSV_EPARSE;
          return at;
        }
        break;
    }
    if (!kept) {
      p.status = out_of_memory;
      return at;
    }
  }
  return size;
}

int csv_fini(csv_parser* parser, csv_field_function on_field, csv_row_function on_row, void* data) {
  csv_parser& p = *parser;
  if (p.state == csv_parser::in_field && p.quoted) {
    p.status = CSV_EPARSE;
    return -1;
  }
  if (p.state != csv_parser::before_row) {
    end_field(p, on_field, data);
    end_row(p, -1, on_row, data);
  }
  return 0;
}
