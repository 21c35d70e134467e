// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "json_place.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace thermopower::io {
namespace {

/// Walks through a text that is known to be JSON.
class PathWalk {
public:
  explicit PathWalk(const std::string& text) : text_(text) {}

  /// Position at which the value of a path begins, or the last value on the way to it.
  std::size_t find(const std::vector<std::string>& path) {
    space();
    std::size_t found = at_;
    for (const std::string& name : path) {
      if (!enter(name)) break;
      found = at_;
    }
    return found;
  }

private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  std::string string() {
    const std::size_t begin = at_++;
    while (here() != '"' && at_ < text_.size()) at_ += here() == '\\' ? 2 : 1;
    ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void skip_value() {
    int depth = 0;
    do {
      space();
      if (here() == '"') string();
      else if (here() == '{' || here() == '[') ++depth, ++at_;
      else if (here() == '}' || here() == ']') --depth, ++at_;
      else if (here() == ',' || here() == ':') ++at_;
      else at_ = std::min(text_.find_first_of(" \t\r\n,:]}", at_), text_.size());
    } while (depth > 0 && at_ < text_.size());
  }

  /// Goes to a member of the object, or an element of the array, that begins here.
  bool enter(const std::string& name) {
    const bool object = here() == '{';
    if (!object && here() != '[') return false;
    ++at_;
    for (std::size_t index = 0;; ++index) {
      space();
      if (here() == ']' || here() == '}' || at_ >= text_.size()) return false;
      std::string key = std::to_string(index);
      if (object) {
        key = nlohmann::json::parse(string()).get<std::string>();
        space();
        ++at_;  // the colon
        space();
      }
      if (key == name) return true;
      skip_value();
      space();
      if (here() == ',') ++at_;
    }
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

std::size_t line_of_pointer(const std::string& text, const std::string& pointer) {
  std::vector<std::string> path;
  for (const char c : pointer) {
    if (c == '/') path.emplace_back();
    else if (!path.empty()) path.back() += c;
  }
  for (std::string& name : path)  // RFC 6901
    for (const auto& [escaped, plain] : {std::pair("~1", '/'), std::pair("~0", '~')})
      for (std::size_t at = 0; (at = name.find(escaped, at)) != std::string::npos; ++at)
        name.replace(at, 2, 1, plain);
  const std::size_t position = PathWalk(text).find(path);
  return 1 + static_cast<std::size_t>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
}

}  // namespace thermopower::io
