// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"

#include <thermopower/io.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace io = thermopower::io;

namespace {

int list_columns(const std::string& path, const std::string& proposal) {
  io::OutputFiles outputs;
  if (!proposal.empty()) {
    if (plain_path(proposal) == plain_path(path))
      throw UsageError("'" + path + "' is named twice; an output must not be an input");
    outputs.expect(proposal);
  }
  std::string text;
  std::vector<io::ListedColumn> columns;
  if (io::is_mcap(path)) {
    const io::McapContents contents = io::list_mcap(path);
    text = io::columns_text(contents);
    columns = contents.columns;
  } else if (io::is_sbgc_capture(path)) {
    const io::SbgcCaptureContents contents = io::list_sbgc_capture(path);
    text = io::columns_text(contents);
    columns = contents.columns;
  } else {
    columns = io::list_columns(path);
    text = io::columns_text(columns, path == "-" ? "log.csv" : path);
  }
  if (!proposal.empty()) outputs.put(proposal, io::column_map_text(columns));
  outputs.commit();
  std::fputs(text.c_str(), stdout);
  return made;
}

}  // namespace

Command add_columns(CLI::App& program) {
  struct Asked {
    std::string file, proposal;
  };
  const auto asked = std::make_shared<Asked>();
  CLI::App* const app =
      program.add_subcommand("columns", "list what is in a file, and propose what its columns are");
  app->add_option("file", asked->file,
                  std::string("a recording (") + recording_kinds + "), - for standard input")
      ->required();
  app->add_option("--proposal", asked->proposal, "write the proposals as a mapping file for --map");
  return {app, [asked] { return list_columns(asked->file, asked->proposal); }};
}
