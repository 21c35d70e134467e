// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// thermopower-gap: where a simulated actuator and the real one part, which effect is missing, and how far the
// gap shrinks with it. Each subcommand has a file of its own, *_command.cpp.

#include "command.hpp"
#include "keep_memory.hpp"
#include "nearest_name.hpp"
#include "program.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/version.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace io = thermopower::io;

namespace {

const CLI::Validator not_empty(
    [](std::string& text) { return text.empty() ? std::string("is empty; expected a name") : std::string(); },
    "", "not empty");

// CLI11's own says only that a subcommand is required.
void expect_subcommand(CLI::App& app, const std::string& given) {
  std::vector<std::string> names;
  for (const CLI::App* const one : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(one->get_name());
  if (std::find(names.begin(), names.end(), given) != names.end()) return;
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  if (given.empty()) throw UsageError("no subcommand is given; expected one of " + list);
  const std::string nearest = io::nearest_name(given, names);
  throw UsageError(
      io::excerpt(given) + " is not a subcommand" +
      (nearest.empty() ? "; expected one of " : "; did you mean " + nearest + "? Expected one of ") + list);
}

// The files that were typed without options, with those they probably belong to.
std::string with_options(const std::vector<std::string>& options, const std::string& required, int count,
                         char** values) {
  const auto known = [&](const char* option) {
    return std::find(options.begin(), options.end(), option) != options.end();
  };
  const std::string expected = "expected " + (required.empty() ? std::string("an option first") : required);
  if (!known("--model") || !known("--recording")) return expected;
  std::string text;
  for (int i = 2; i < count && values[i][0] != '-'; ++i) {
    const std::string word = values[i];
    const bool is_model = word.size() > 5 && word.compare(word.size() - 5, 5, ".json") == 0;
    text += std::string(is_model ? " --model " : " --recording ") + word;
  }
  return "did you mean" + text + "?";
}

// Says of an option that its value is missing, or that it is given again: CLI11's own speaks of its types.
void expect_value_once(const CLI::Option& option, const std::string& word, const char* next, int count) {
  const bool takes_one = option.get_expected_min() > 0;
  if (takes_one && word.find('=') == std::string::npos &&
      (next == nullptr || std::string(next).compare(0, 2, "--") == 0))
    throw UsageError(word + ": no value stands behind it; expected one, as in " + word + " " +
                     (option.get_type_name() == "TEXT" ? "FILE" : "NUMBER"));
  if (count > 1 && option.get_expected_max() == 1 &&
      option.get_multi_option_policy() == CLI::MultiOptionPolicy::Throw)
    throw UsageError(word.substr(0, word.find('=')) + ": is given " + std::to_string(count) +
                     " times; expected once");
}

// Says what was typed that no option is, before the parser says what is missing.
void expect_options(const CLI::App& subcommand, int count, char** values) {
  std::vector<std::string> options = {"--help"};
  std::string required;
  bool takes_words = false;
  for (const CLI::Option* const one : subcommand.get_options([](const CLI::Option*) { return true; })) {
    for (const std::string& name : one->get_lnames()) options.push_back("--" + name);
    takes_words = takes_words || one->get_positional();
    if (one->get_required()) required += (required.empty() ? "" : " ") + one->get_name() + " ...";
  }
  std::map<std::string, int> times;
  for (int i = 2; i < count; ++i) {
    const std::string word = values[i];
    const std::string name = word.substr(0, word.find('='));
    if (name.size() > 2 && name.compare(0, 2, "--") == 0) {
      if (const CLI::Option* const option = subcommand.get_option_no_throw(name)) {
        expect_value_once(*option, word, i + 1 < count ? values[i + 1] : nullptr, ++times[name]);
        continue;
      }
      const std::string nearest = io::nearest_name(name, options);
      throw UsageError("there is no option " + name + " of " + subcommand.get_name() +
                       (nearest.empty()
                            ? "; 'thermopower-gap " + subcommand.get_name() + " --help' lists them"
                            : "; did you mean " + nearest + "?"));
    }
    const bool is_letter =
        name.size() == 2 && name[0] == '-' && name[1] >= 'a' && name[1] <= 'z' && name != "-h";
    if (is_letter) {
      for (const std::string& option : options)
        if (option[2] == name[1])
          throw UsageError("there is no option " + name + "; did you mean " + option + "?");
      throw UsageError("there is no option " + name + "; options are spelt out: " + required);
    }
    if (i == 2 && !takes_words && !word.empty() && word[0] != '-')
      throw UsageError(io::excerpt(word) + " stands before any option; " +
                       with_options(options, required, count, values));
  }
}

std::string version() {
  using thermopower::Version;
  return std::to_string(Version::major_number()) + "." + std::to_string(Version::minor_number()) + "." +
         std::to_string(Version::patch_number());
}

int run(int count, char** values) {
  CLI::App app(
      "Says where a simulated actuator and the real one part, which effect is missing, and how far the gap shrinks with it.",
      "thermopower-gap");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, whatever the verdict, 1 a fault of the program itself, 2 wrong usage, 3 unreadable or invalid input, 4 too little data, or data that cannot be believed as they stand, or no experiment that decides.");
  const std::vector<Command> commands = {add_diagnose(app), add_design(app),  add_predict(app),
                                         add_check(app),    add_export(app),  add_columns(app),
                                         add_fleet(app),    add_effects(app), add_init(app),
                                         add_explain(app),  add_compare(app), add_impact(app)};
  for (const Command& command : commands)
    for (CLI::Option* const option : command.app->get_options([](const CLI::Option*) { return true; }))
      if (option->get_expected_min() > 0) option->check(not_empty);

  if (count == 1) expect_subcommand(app, {});
  if (count > 1 && values[1][0] != '-') {
    expect_subcommand(app, values[1]);
    expect_options(*app.get_subcommand(values[1]), count, values);
  }
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? made : wrong_usage;
  }
  for (const Command& command : commands)
    if (*command.app) return command.run();
  return wrong_usage;
}

}  // namespace

int main(int count, char** values) {
  keep_memory();
  std::string fault;
  const int status = guarded([&] { return run(count, values); }, fault);
  if (!fault.empty()) {
    std::fprintf(stderr, "%s\n", fault.c_str());
    return status;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fputs("thermopower-gap: standard output cannot be written\n", stderr);
    return invalid_input;
  }
  return status;
}
