// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"

#include <thermopower/io.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace io = thermopower::io;

namespace {

int list_columns(const std::string& path, const std::string& proposal, const std::string& joint) {
  io::OutputFiles outputs;
  if (!proposal.empty()) {
    if (plain_path(proposal) == plain_path(path))
      throw UsageError("'" + path + "' is named twice; an output must not be an input");
    outputs.expect(proposal);
  }
  const io::LogContents contents = io::list_log(path, joint);
  const bool known = std::any_of(contents.columns.begin(), contents.columns.end(), [&](const auto& one) {
    return one.header.find(joint) != std::string::npos;
  });
  if (!joint.empty() && !known && !contents.columns.empty())
    throw UsageError("--joint " + joint + ": no column of " + path + " has that in its header");
  const std::string text = io::columns_text(contents);
  if (!proposal.empty()) outputs.put(proposal, io::column_map_text(contents.columns));
  outputs.commit();
  std::fputs(text.c_str(), stdout);
  return made;
}

}  // namespace

Command add_columns(CLI::App& program) {
  struct Asked {
    std::string file, proposal, joint;
  };
  const auto asked = std::make_shared<Asked>();
  CLI::App* const app =
      program.add_subcommand("columns", "list what is in a file, and propose what its columns are");
  app->add_option("file", asked->file,
                  std::string("a recording (") + recording_kinds + "), - for standard input")
      ->required();
  app->add_option("--proposal", asked->proposal, "write the proposals as a mapping file for --map");
  app->add_option("--joint", asked->joint,
                  "word in the headers of the joint or heater that is meant; without it the one that moves");
  return {app, [asked] { return list_columns(asked->file, asked->proposal, asked->joint); }};
}
