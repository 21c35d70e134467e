// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// What csv_table.cpp asks of libcsv 3, written anew: Debian has that library compiled for its own machines only, and a
// browser needs it too. Strict, as asked for there: a quote stands around a whole field or doubled inside one. Blanks
// around a field go. tests/thermopower-gap runs the tests of csv_table.cpp with either.

#include <cstddef>

enum { CSV_EPARSE = 1, CSV_STRICT = 1, CSV_REPALL_NL = 2, CSV_STRICT_FINI = 4 };

struct csv_parser {
  enum State { before_row, before_field, in_field, after_quote };
  State state;
  int quoted;
  std::size_t entry_pos;  ///< bytes of the field so far
  char* entry_buf;
  std::size_t entry_size;
  std::size_t blanks;  ///< of which at the end
  char delimiter;
  int status;
};

using csv_field_function = void (*)(void*, std::size_t, void*);
using csv_row_function = void (*)(int, void*);

int csv_init(csv_parser* parser, unsigned char options);
void csv_free(csv_parser* parser);
void csv_set_blk_size(csv_parser* parser, std::size_t size);
void csv_set_delim(csv_parser* parser, unsigned char delimiter);
/// Bytes taken; fewer than given where it stopped: csv_error() tells why.
std::size_t csv_parse(csv_parser* parser, const void* bytes, std::size_t size, csv_field_function on_field,
                      csv_row_function on_row, void* data);
/// The last row, where no line break ended it. 0, or not where a quote is still open.
int csv_fini(csv_parser* parser, csv_field_function on_field, csv_row_function on_row, void* data);
int csv_error(csv_parser* parser);
