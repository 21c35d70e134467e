// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Every public class has an example on its page that is compiled and run, a link to where it is used, and, where it stands in
// a menu, a link to that. A struct that only carries values is named by the function or the class that takes or gives it.

#include "../catch.hpp"
#include "../../tools/thermopower-gap/text_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  return lines;
}

/// A class at namespace scope. The tree is formatted: such a class begins in column 0, its members two columns further in.
struct Class {
  std::string header, name, doc, body;
  /// It does something: it has a member function besides those by which it is set up, checked and stored.
  bool acts = false;
};

bool is_plumbing(const std::string& function, const std::string& class_name) {
  static const std::set<std::string> plumbing = {"validate", "standard", "each_field", "static_assert",
                                                 "decltype", "defined",  "if",         "return"};
  return plumbing.count(function) == 1 || function == class_name || function == "~" + class_name;
}

std::vector<Class> classes_in(const std::string& header, const std::string& text) {
  static const std::regex head(R"(^(?:struct|class) (\w+)(?: final)?(?: : .*)?(?: \{.*)?$)"),
      function(R"(^  (?! )(?!typedef|using|friend|//|operator)[^=(]*?(~?\w+)\()"),
      opened(R"(^namespace (?:[\w:]+::)?(\w+) \{$)"), closed(R"(^\}  // namespace.*$)");
  std::vector<Class> found;
  std::vector<std::string> spaces;
  const std::vector<std::string> lines = lines_in(text);
  for (size_t at = 0; at < lines.size(); ++at) {
    std::smatch match;
    if (std::regex_match(lines[at], match, opened)) spaces.push_back(match[1]);
    else if (std::regex_match(lines[at], closed) && !spaces.empty()) spaces.pop_back();
    if (!std::regex_match(lines[at], match, head) || lines[at].find(';') != std::string::npos) continue;
    if (std::count(spaces.begin(), spaces.end(), "detail") +
            std::count(spaces.begin(), spaces.end(), "engine") >
        0)
      continue;
    Class one;
    one.header = header;
    one.name = match[1];
    size_t top = at;  // of the template's head, which ends in '>'
    if (at > 0 && !lines[at - 1].empty() && lines[at - 1].back() == '>' && lines[at - 1].rfind("///", 0) != 0)
      while (top > 0 && lines[top].rfind("template", 0) != 0) --top;
    for (size_t up = top; up-- > 0 && lines[up].rfind("///", 0) == 0;) one.doc = lines[up] + "\n" + one.doc;
    if (one.doc.find("@copydoc") != std::string::npos) continue;  // a specialisation
    bool is_public = lines[at].rfind("struct", 0) == 0;
    for (size_t down = at + 1; down < lines.size() && lines[down].rfind("};", 0) != 0; ++down) {
      one.body += lines[down] + "\n";
      if (lines[down] == "public:") is_public = true;
      if (lines[down] == "private:" || lines[down] == "protected:") is_public = false;
      const std::string code = lines[down].substr(0, lines[down].find("//"));
      if (is_public && std::regex_search(code, match, function) && !is_plumbing(match[1], one.name) &&
          code.find("operator") == std::string::npos)
        one.acts = true;
    }
    found.push_back(one);
  }
  return found;
}

const fs::path root = THERMOPOWER_ROOT;

/// The stages inside a diagnosis, and what steps a simulation from row to row: nothing outside of the library names them.
/// Model, simulate() and diagnose() lead to them; their pages link to how the whole works.
bool is_a_stage(const std::string& header) {
  static const std::regex stages(
      "^gap/(data|localise|propose|fit|decide|compare|report|detail)/|^(design|robot)/|^plant/(axis_at_rows|axis_effort|axis_step|balance|bench_at_rows|body_network)\\.hpp$");
  return std::regex_search(header, stages);
}

std::map<std::string, std::string> headers() {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(root / "include/thermopower")) {
    const std::string name = fs::relative(entry.path(), root / "include/thermopower").generic_string();
    if (entry.path().extension() == ".hpp" && name.find("detail/") == std::string::npos)
      all[name] = read_text(entry.path());
  }
  return all;
}

/// Whether a word stands in a text, by itself.
bool names(const std::string& text, const std::string& word) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if ((at == 0 || !is_part(text[at - 1])) &&
        (at + word.size() == text.size() || !is_part(text[at + word.size()])))
      return true;
  return false;
}

/// What `@snippet file label` shows; empty where there is no such file, or not one, or the label is not there twice. The file
/// must be named by the CMakeLists.txt of a folder that it lies in, or be included by one that is.
std::string snippet(const std::string& file, const std::string& label) {
  std::string shown;
  int files = 0;
  for (const char* folder : {"examples", "tests/docs/examples"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string path = entry.path().generic_string();
      if (path.size() < file.size() + 1 ||
          path.compare(path.size() - file.size() - 1, std::string::npos, "/" + file) != 0)
        continue;
      ++files;
      const std::string text = read_text(entry.path()), mark = "//! [" + label + "]\n";
      const size_t from = text.find(mark), to = text.find(mark, from + 1);
      if (from == std::string::npos || to == std::string::npos) continue;
      bool is_compiled = entry.path().extension() == ".hpp";
      for (fs::path up = entry.path().parent_path(); !is_compiled && up != root; up = up.parent_path())
        if (fs::exists(up / "CMakeLists.txt")) {
          // A folder's programs are named by their sources, or, of the examples here, by their rooms.
          const std::string build = read_text(up / "CMakeLists.txt"), stem = entry.path().stem().string();
          is_compiled = names(build, stem) || names(build, stem.substr(0, stem.rfind("_examples")));
        }
      if (is_compiled) shown = text.substr(from + mark.size(), to - from - mark.size());
    }
  return files == 1 ? shown : std::string();
}

/// Ids of the pages that people read, menus aside.
std::set<std::string> pages() {
  std::set<std::string> ids;
  static const std::regex id(R"(^<!-- page (\w+) -->$)");
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    std::smatch match;
    if (entry.path().extension() != ".md") continue;
    for (const std::string& line : lines_in(read_text(entry.path())))
      if (std::regex_match(line, match, id)) ids.insert(match[1]);
  }
  ids.erase("policies");
  return ids;
}

/// What of the rule a class's doc comment breaks; empty: nothing.
std::string broken(const Class& one, const std::set<std::string>& known_pages,
                   const std::set<std::string>& in_menus) {
  static const std::regex link(R"(@ref (\w+))"), example(R"(@snippet (\S+) ([^\n]+))");
  bool leads_to_a_page = false, leads_to_the_menu = false, shows_itself = false;
  for (std::sregex_iterator i(one.doc.begin(), one.doc.end(), link), end; i != end; ++i) {
    leads_to_a_page = leads_to_a_page || known_pages.count((*i)[1]) == 1;
    leads_to_the_menu = leads_to_the_menu || (*i)[1] == "policies";
  }
  for (std::sregex_iterator i(one.doc.begin(), one.doc.end(), example), end; i != end; ++i)
    shows_itself = shows_itself || names(snippet((*i)[1], (*i)[2]), one.name);
  std::string text;
  if (!leads_to_a_page) text += " no link to a page;";
  if (in_menus.count(one.name) == 1 && !leads_to_the_menu) text += " no link to the menu;";
  if (!shows_itself && !is_a_stage(one.header)) text += " no compiled example that names it;";
  return text;
}

}  // namespace

TEST_CASE("every public class that does something has an example, a link to its how-to, and to its menu") {
  const std::set<std::string> known_pages = pages();
  REQUIRE(known_pages.size() > 30);
  // The menus: what stands in the first column of the tables of policies.md.
  std::set<std::string> in_menus;
  // So does what takes them: every class of a header that has a menu.
  static const std::regex row(R"(^\| `(\w+)[^|]*\|)"), heading(R"(^## (\S+\.hpp)$)");
  std::set<std::string> have_a_menu = {"control/axis_controller.hpp",
                                       "control/fixed_point/axis_controller.hpp"};
  for (const std::string& line : lines_in(read_text(root / "docs/reference/policies.md"))) {
    std::smatch match;
    if (std::regex_search(line, match, row)) in_menus.insert(match[1]);
    if (std::regex_match(line, match, heading)) have_a_menu.insert(match[1]);
  }
  CHECK(in_menus.size() > 30);
  int count = 0;
  for (const auto& [header, text] : headers())
    for (const Class& one : classes_in(header, text)) {
      if (!one.acts) continue;
      ++count;
      std::set<std::string> menus = in_menus;
      if (have_a_menu.count(header) == 1) menus.insert(one.name);
      const std::string what = broken(one, known_pages, menus);
      INFO(header << ": " << one.name << ":" << what);
      CHECK(what.empty());
    }
  CHECK(count > 200);
}

TEST_CASE("every public struct of values is named by what takes or gives it") {
  // Code without comments but for what is thrown.
  std::map<std::string, std::string> all;
  for (const auto& [header, text] : headers())
    for (const std::string& line : lines_in(text))
      all[header] +=
          line.find("@throws") == std::string::npos ? line.substr(0, line.find("//")) + "\n" : line + "\n";
  for (const auto& [header, text] : headers())
    for (const Class& one : classes_in(header, text)) {
      if (one.acts) continue;
      int named = one.doc.find("@snippet") != std::string::npos ? 1 : 0;
      for (const auto& [other, code] : all) {
        if (other != header) {
          named += names(code, one.name) ? 1 : 0;
          continue;
        }
        // In its own header besides the line that declares it.
        int lines = 0;
        for (const std::string& line : lines_in(code)) lines += names(line, one.name) ? 1 : 0;
        named += lines > 1 ? 1 : 0;
      }
      INFO(header << ": " << one.name);
      CHECK(named > 0);
    }
}

TEST_CASE("the rule itself sees what it looks for") {
  const std::string good =
      "namespace a {\n/// B.\n/// @snippet actuator_examples.cpp cooling\n/// @ref policies @ref custom_motor\n"
      "template <class T = float>\nstruct NewtonCooling {\n  T loss_W() const;\n};\n}  // namespace a\n";
  const std::vector<Class> found = classes_in("x.hpp", good);
  REQUIRE(found.size() == 1);
  CHECK(found[0].acts);
  const std::set<std::string> known = pages(), menus = {"NewtonCooling"};
  CHECK(broken(found[0], known, menus).empty());
  Class other = found[0];
  other.name = "Unknown";
  CHECK(broken(other, known, menus) == " no compiled example that names it;");
  other = found[0];
  other.doc = "/// @snippet actuator_examples.cpp cooling";
  CHECK(broken(other, known, menus) == " no link to a page; no link to the menu;");
  CHECK(classes_in("x.hpp", "namespace detail {\nstruct A {\n  int f();\n};\n}  // namespace detail\n")
            .empty());
  CHECK_FALSE(classes_in("x.hpp", "struct A {\n  int a;\n  int validate() const;\n};\n")[0].acts);
  CHECK_FALSE(classes_in("x.hpp", "class A {\n  int f();\npublic:\n  A(int);\n};\n")[0].acts);
  CHECK(snippet("actuator_examples.cpp", "no such label").empty());
  CHECK(snippet("no_such_file.cpp", "cooling").empty());
}
