// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/provenance.hpp>

#include "html_text.hpp"

#include <thermopower/version.hpp>

#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>

namespace thermopower::io {
namespace {

constexpr std::size_t most_files = 6;

std::string files(const std::vector<std::string>& paths) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most_files, paths.size()); ++i)
    text += (i == 0 ? "" : ", ") + path_for_others(paths[i]);
  if (paths.size() > most_files) text += " and " + std::to_string(paths.size() - most_files) + " more";
  return text;
}

}  // namespace

std::string today() {
  const char* const fixed = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t now = fixed != nullptr && *fixed != '\0'
                              ? static_cast<std::time_t>(std::strtoll(fixed, nullptr, 10))
                              : std::time(nullptr);
  char text[32] = "";
  std::tm parts = {};
  if (gmtime_r(&now, &parts) != nullptr) std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

std::string version_text() {
  return std::to_string(Version::major_number()) + "." + std::to_string(Version::minor_number()) + "." +
         std::to_string(Version::patch_number());
}

std::string path_for_others(const std::string& path) {
  const bool absolute = !path.empty() && (path[0] == '/' || (path.size() > 2 && path[1] == ':'));
  return absolute ? path.substr(path.find_last_of("/\\") + 1) : path;
}

std::string provenance_line(const Provenance& made_of) {
  if (!is_told(made_of)) return {};
  std::string text;
  if (!made_of.model.empty()) text += "Model " + files({made_of.model}) + ". ";
  if (!made_of.recordings.empty()) {
    text += "Recorded: " + files(made_of.recordings) + ". Held out: ";
    text += (made_of.held_out.empty() ? "the end of each recording" : files(made_of.held_out)) + ". ";
    text += "Options: " + (made_of.options.empty() ? "as they come" : joined(made_of.options, " ")) + ". ";
  }
  text += "thermopower " + version_text();
  if (!made_of.date.empty()) text += ", " + made_of.date;
  return text + ".";
}

}  // namespace thermopower::io
