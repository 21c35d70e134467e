// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Rules for the headers, those that run in firmware above all, which no compiler enforces.

#include "../catch.hpp"
#include "../../tools/thermopower-gap/text_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

/// The text without comments and with empty string literals; line breaks stay.
std::string code_of(const std::string& text) {
  std::string code;
  for (size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0) {
      while (i < text.size() && text[i] != '\n') ++i;
    } else if (text.compare(i, 2, "/*") == 0) {
      for (i += 2; i < text.size() && text.compare(i, 2, "*/") != 0; ++i)
        if (text[i] == '\n') code += '\n';
      i += 2;
    } else if (text[i] == '"' && code.find_last_of('\n') != std::string::npos &&
               code.compare(code.find_last_of('\n') + 1, 8, "#include") != 0) {
      code += "\"\"";
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
      ++i;
    } else {
      code += text[i++];
    }
  }
  return code;
}

struct Header {
  std::string name;  // relative to include/thermopower
  std::string text, code;
  std::vector<std::string> quoted, angled;
  std::set<std::string> identifiers;
};

bool is_firmware(const std::string& name) {
  static const std::regex upstairs("^(simulation|plant|gap|design|io|robot)/|^(desktop|gap|io)\\.hpp$");
  return !std::regex_search(name, upstairs);
}

/// Every header, of both floors.
const std::map<std::string, Header>& every_header() {
  static const std::map<std::string, Header> all = [] {
    std::map<std::string, Header> found;
    const fs::path root = THERMOPOWER_INCLUDE;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (entry.path().extension() != ".hpp") continue;
      Header header;
      header.name = fs::relative(entry.path(), root).generic_string();
      header.text = read_text(entry.path());
      header.code = code_of(header.text);
      static const std::regex include(R"re(#include\s*([<"])([^>"]+)[>"])re"), word("[A-Za-z0-9_]+");
      for (std::sregex_iterator i(header.code.begin(), header.code.end(), include), end; i != end; ++i)
        ((*i)[1] == "<" ? header.angled : header.quoted).push_back((*i)[2]);
      const std::string plain = std::regex_replace(header.code, std::regex("#include[^\n]*"), "");
      for (std::sregex_iterator i(plain.begin(), plain.end(), word), end; i != end; ++i)
        if (!std::isdigit(static_cast<unsigned char>(i->str()[0]))) header.identifiers.insert(i->str());
      found[header.name] = header;
    }
    return found;
  }();
  return all;
}

/// Those that run in firmware.
const std::map<std::string, Header>& headers() {
  static const std::map<std::string, Header> firmware = [] {
    std::map<std::string, Header> found;
    for (const auto& [name, header] : every_header())
      if (is_firmware(name)) found[name] = header;
    return found;
  }();
  return firmware;
}

/// What a header includes of ours, as names relative to include/thermopower.
std::set<std::string> included_by(const Header& header) {
  std::set<std::string> ours;
  for (const std::string& included : header.quoted)
    ours.insert((fs::path(header.name).parent_path() / included).lexically_normal().generic_string());
  const std::string prefix = "thermopower/";
  for (const std::string& included : header.angled)
    if (included.rfind(prefix, 0) == 0) ours.insert(included.substr(prefix.size()));
  return ours;
}

/// Everything a header includes of ours, however indirectly, itself among it.
void reach(const std::string& name, std::set<std::string>& reached) {
  if (!reached.insert(name).second) return;
  const auto found = every_header().find(name);
  if (found == every_header().end()) return;
  for (const std::string& included : included_by(found->second)) reach(included, reached);
}

/// The room a header lives in: its folder below include/thermopower, of the diagnosis its stage.
std::string room_of(const std::string& name) {
  static const std::regex room(
      "^gap/(data|observe|units|fit|where|propose|compare|report|pool|detail)/|^[a-z_]+/");
  std::smatch found;
  return std::regex_search(name, found, room) ? found.str() : std::string();
}

/// Names in a list as `-dM -E` prints it.
std::set<std::string> macros_in(const std::string& path) {
  std::ifstream file(path);
  std::set<std::string> macros;
  for (std::string define, name, line; std::getline(file, line);) {
    std::istringstream words(line);
    words >> define >> name;
    macros.insert(name.substr(0, name.find('(')));
  }
  return macros;
}

/// Enumerators that a user can name and that no comment explains, neither behind them nor in the line before.
std::vector<std::string> unexplained_enumerators(const std::string& text) {
  static const std::regex type(
      "\\b(class|struct|union|namespace)\\s+([\\w:]*)(?:<.*>)?\\s*(?:final\\s*)?(?::[^()]*)?$"),
      enumeration("\\benum\\b[^()]*$"), access("\\b(public|private|protected)$"),
      name("^([A-Za-z]\\w*)\\s*(=|$)");
  std::vector<std::string> lines = {""}, unexplained;
  for (const char c : text) {
    if (c == '\n') lines.emplace_back();
    else lines.back() += c;
  }
  struct Scope {
    bool reached, open, is_enum;
    size_t line;
  };
  std::vector<Scope> scopes = {{true, true, false, 0}};
  const auto is_public = [&] { return scopes.back().reached && scopes.back().open; };
  std::string head;  // since the last brace, comma or semicolon
  size_t line = 0, head_line = 0;
  const auto end_of_enumerator = [&] {
    std::smatch found;
    if (!scopes.back().is_enum || !is_public() || !std::regex_search(head, found, name)) return;
    const std::string& own = lines[head_line];
    const std::string above = head_line == scopes.back().line ? "" : lines[head_line - 1];
    const bool is_explained = own.find("///<") != std::string::npos ||
                              own.find("/**<") != std::string::npos ||
                              std::regex_search(above, std::regex("^ *///(?!<)"));
    if (!is_explained) unexplained.push_back(found[1]);
  };
  for (const char c : code_of(text)) {
    if (c == '\n') ++line;
    if (c == '{') {
      std::smatch found;
      const bool is_enum = std::regex_search(head, enumeration),
                 is_type = std::regex_search(head, found, type);
      const bool is_open = is_enum || (is_type && found[1] != "class" && found[2] != "detail");
      scopes.push_back({is_public() && (is_enum || is_type), is_open, is_enum, line});
    } else if (c == '}') {
      end_of_enumerator();
      if (scopes.size() > 1) scopes.pop_back();
    } else if (c == ',') {
      end_of_enumerator();
    } else if (c == ':' && !scopes.back().is_enum && std::regex_search(head, access)) {
      scopes.back().open = head == "public";
    } else if (c != ';') {
      if (head.empty() && std::isspace(static_cast<unsigned char>(c))) continue;
      if (head.empty()) head_line = line;
      head += c == '\n' ? ' ' : c;
      continue;
    }
    if (c != ',' || scopes.back().is_enum) head.clear();
    else head += c;
  }
  return unexplained;
}

}  // namespace

TEST_CASE("there are firmware headers to check") { CHECK(headers().size() > 40); }

TEST_CASE("every header begins with its licence and is included once") {
  CHECK(every_header().size() > headers().size() + 50);
  for (const auto& [name, header] : every_header()) {
    CAPTURE(name);
    CHECK(header.text.rfind(
              "// SPDX-License-Identifier: MIT\n// Copyright (c) 2026 the thermopower authors\n", 0) == 0);
    CHECK(header.text.find("#pragma once") != std::string::npos);
  }
}

TEST_CASE("firmware headers include nothing that avr-libc lacks") {
  const std::set<std::string> allowed = {"stdint.h", "stddef.h", "math.h", "string.h", "avr/pgmspace.h"};
  for (const auto& [name, header] : headers()) {
    for (const std::string& included : header.angled) {
      CAPTURE(name, included);
      CHECK(allowed.count(included) == 1);
    }
  }
}

TEST_CASE("firmware headers reach nothing upstairs, however indirectly") {
  for (const auto& [name, header] : headers()) {
    std::set<std::string> reached;
    reach(name, reached);
    for (const std::string& other : reached) {
      CAPTURE(name, other);
      CHECK(is_firmware(other));
      CHECK(every_header().count(other) == 1);  // an include that leads nowhere
    }
  }
}

TEST_CASE("dependencies point one way: the actuator knows no control, the wire knows neither") {
  const std::map<std::string, std::string> forbidden = {
      {"actuator", "^(control|sbgc|motors)/"},
      {"motors", "^(control|sbgc)/"},
      {"control", "^(actuator|sbgc|motors)/"},
      {"sbgc", "^(actuator|control|motors)/"},
      {"monitor", "^(actuator|control/(?!limit_reason)|sbgc|motors)/"}};
  for (const auto& [name, header] : headers()) {
    const auto rule = forbidden.find(name.substr(0, name.find('/')));
    if (rule == forbidden.end()) continue;
    std::set<std::string> reached;
    reach(name, reached);
    for (const std::string& other : reached) {
      CAPTURE(name, other);
      CHECK_FALSE(std::regex_search(other, std::regex(rule->second)));
    }
  }
}

TEST_CASE("upstairs no include runs back up, and each leads somewhere") {
  // What each room must not reach: in the diagnosis every arrow points one way, and none leads back to the data. The pool knows a
  // diagnosis by its verdict, which is a word.
  const std::map<std::string, std::string> forbidden = {
      {"plant/", "^(control|sbgc|simulation|gap|design|io)/|^(desktop|gap|io)\\.hpp"},
      {"simulation/", "^(gap|design|io)/|^(desktop|gap|io)\\.hpp"},
      {"gap/", "^(control|sbgc|simulation|design|io)/|^(desktop|gap|io)\\.hpp"},
      {"design/", "^(control|sbgc|simulation|io|robot)/|^(desktop|io)\\.hpp"},
      {"gap/data/",
       "^gap/(observe|units|fit|where|propose|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/observe/",
       "^gap/(units|fit|where|propose|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/units/",
       "^gap/(fit|where|propose|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/fit/",
       "^gap/(units|where|propose|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/where/",
       "^gap/(observe|units|fit|propose|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/propose/", "^gap/(units|where|compare|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/compare/", "^gap/(units|where|report|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/report/", "^gap/(units|pool|detail)/|^gap/(diagnose|definitions)\\.hpp"},
      {"gap/pool/",
       "^plant/|^gap/(data|observe|units|fit|where|propose|compare|report|detail)/|^gap/(?!verdict\\.)[a-z_]+\\.hpp"}};
  std::set<std::string> seen;
  for (const auto& [name, header] : every_header()) {
    std::set<std::string> reached;
    reach(name, reached);
    const std::string room = room_of(name);
    seen.insert(room);
    for (const std::string& other : reached) {
      CAPTURE(name, other);
      CHECK(every_header().count(other) == 1);
      for (const auto& [from, to] : forbidden)
        if (room.rfind(from, 0) == 0) CHECK_FALSE(std::regex_search(other, std::regex(to)));
    }
  }
  for (const auto& [from, to] : forbidden) {
    CAPTURE(from);
    CHECK(seen.count(from) == 1);  // a rule for a room that is gone checks nothing
  }
}

TEST_CASE(
    "nothing public lives in a detail/: what users include reaches it only to define what it declares") {
  const std::regex detail("(^|/)detail/"), definitions("^(gap|plant)/detail/");
  for (const auto& [name, header] : every_header()) {
    if (is_firmware(name) || std::regex_search(name, detail)) continue;
    for (const std::string& other : included_by(header)) {
      if (!std::regex_search(other, definitions)) continue;
      CAPTURE(name, other);
      // gap/x.hpp takes its definitions from gap/detail/x.hpp, and nobody else does.
      const bool own =
          fs::path(name).filename() == fs::path(other).filename() || name == "gap/definitions.hpp";
      CHECK(own);
    }
  }
}

TEST_CASE(
    "one include style a floor: downstairs relative, as a copy in a sketchbook needs it; upstairs by full name") {
  for (const auto& [name, header] : every_header()) {
    CAPTURE(name);
    if (!is_firmware(name)) {
      CHECK(header.quoted.empty());
    } else {
      for (const std::string& included : header.angled) CHECK(included.rfind("thermopower/", 0) != 0);
    }
  }
}

TEST_CASE("the umbrella holds every firmware header") {
  std::set<std::string> reached;
  reach("thermopower.hpp", reached);
  for (const auto& [name, header] : headers()) {
    CAPTURE(name);
    CHECK(reached.count(name) == 1);
  }
}

TEST_CASE("firmware headers use no heap, no exception, no run-time type, no clock and no standard library") {
  for (const auto& [name, header] : headers()) {
    for (const char* word : {"new", "delete", "malloc", "calloc", "realloc", "free", "throw", "try", "catch",
                             "dynamic_cast", "typeid", "std", "millis", "micros", "clock", "thread_local"}) {
      CAPTURE(name, word);
      CHECK(header.identifiers.count(word) == 0);
    }
  }
}

TEST_CASE("firmware headers declare no name that Arduino.h takes as a macro") {
  std::set<std::string> macros = macros_in(THERMOPOWER_ARDUINO_MACROS);
  if (macros.empty()) {
    WARN("no Arduino core here: names are not checked against its macros");
    return;
  }
  REQUIRE(macros.count("abs") == 1);
  // What the tool chain's own headers define is used as what it is.
  for (const std::string& name : macros_in(THERMOPOWER_ARDUINO_MACROS ".bare")) macros.erase(name);
  CHECK(macros.size() > 500);
  for (const auto& [name, header] : headers()) {
    for (const std::string& identifier : header.identifiers) {
      if (macros.count(identifier) == 0) continue;
      CAPTURE(name, identifier);
      CHECK(false);
    }
  }
}

TEST_CASE(
    "firmware headers have no names in capitals, none of one capital letter, and none that is reserved") {
  const std::set<std::string> meant = {"NAN",     "INFINITY",         "PROGMEM", "THERMOPOWER_FLASH_HEADER",
                                       "__AVR__", "__SIZEOF_DOUBLE__"};
  const std::regex capitals("[A-Z][A-Z0-9_]*"), reserved("_[A-Z].*|.*__.*");
  for (const auto& [name, header] : headers()) {
    for (const std::string& identifier : header.identifiers) {
      if (meant.count(identifier) == 1) continue;
      CAPTURE(name, identifier);
      CHECK_FALSE(std::regex_match(identifier, capitals));
      CHECK_FALSE(std::regex_match(identifier, reserved));
    }
  }
}

TEST_CASE("the rooms of the diagnosis's engine say nothing in the namespace that users autocomplete") {
  std::size_t rooms = 0;
  for (const auto& [name, header] : every_header()) {
    if (!std::regex_search(name, std::regex("^gap/(units|fit|where|propose|compare|report)/"))) continue;
    ++rooms;
    CAPTURE(name);
    CHECK(header.code.find("namespace thermopower::gap::engine {") != std::string::npos);
    CHECK(header.code.find("namespace thermopower::gap {") == std::string::npos);
  }
  CHECK(rooms > 20);
}

/// Lines that are neither empty nor a comment alone.
long code_lines(const std::string& code) {
  std::istringstream lines(code);
  long count = 0;
  for (std::string line; std::getline(lines, line);)
    count += line.find_first_not_of(" \t") != std::string::npos;
  return count;
}

TEST_CASE("a header has one idea: at most 450 lines of code") {
  for (const auto& [name, header] : every_header()) {
    CAPTURE(name);
    CHECK(code_lines(header.code) <= 450);
  }
}

TEST_CASE("a comment says what each public enumerator means") {
  // Doxygen, which holds every other public name to it, lets an enumerator without words pass.
  for (const auto& [name, header] : every_header()) {
    if (name.find("detail/") != std::string::npos) continue;
    for (const std::string& enumerator : unexplained_enumerators(header.text)) {
      CAPTURE(name, enumerator);
      CHECK(false);
    }
  }
}

TEST_CASE("the checks themselves see what they look for") {
  const std::vector<std::string> b = {"b"}, none;
  CHECK(unexplained_enumerators("enum A {\n  a,  ///< x\n  b\n};") == b);
  CHECK(unexplained_enumerators("template <class T, class U>\nstruct S : T {\n  enum { b = 1 };\n};") == b);
  CHECK(unexplained_enumerators("class S {\npublic:\n  enum class A : int { b };\n};") == b);
  CHECK(unexplained_enumerators("enum A {\n  /// x\n  a,\n  b,\n};") == b);
  CHECK(unexplained_enumerators(
            "class S {\n  enum A { b };\npublic:\n  int f(int, int) { return {}; }\n};") == none);
  CHECK(unexplained_enumerators("namespace detail {\nenum A { b };\n}\nvoid f() {\n  enum { c };\n}") ==
        none);
  CHECK(code_of("int a; // new\nint b;") == "int a; \nint b;");
  CHECK(code_of("x /* throw\n */ y") == "x \n y");
  CHECK(code_lines(code_of("int a;  // b\n\n// c\n/* d\n */\nint e;\n")) == 2);
  CHECK(code_of("\nf(\"new // \\\" x\");") == "\nf(\"\");");
  CHECK(code_of("\n#include \"a.hpp\"\n") == "\n#include \"a.hpp\"\n");
}

TEST_CASE("thresholds name the test that holds them, and each of them says what it is") {
  const fs::path root = fs::path(THERMOPOWER_INCLUDE).parent_path().parent_path();
  const std::regex begin(R"re(((?:///[^\n]*\n)+)struct (\w+Thresholds) \{\n)re"),
      test(R"re(tests/[a-z_/]+\.cpp)re");
  std::size_t structs = 0;
  for (const auto& [name, header] : every_header())
    for (std::sregex_iterator i(header.text.begin(), header.text.end(), begin), end; i != end; ++i) {
      CAPTURE(name, (*i)[2].str());
      ++structs;
      const std::string comment = (*i)[1];
      std::size_t tests = 0;
      for (std::sregex_iterator t(comment.begin(), comment.end(), test); t != end; ++t, ++tests)
        CHECK(fs::exists(root / t->str()));
      CHECK(tests > 0);
      // A comment behind a threshold, on its line or the next one, or before it.
      const std::string body =
          header.text.substr(static_cast<std::size_t>(i->position() + i->length()),
                             header.text.find("\n};", static_cast<std::size_t>(i->position())) -
                                 static_cast<std::size_t>(i->position() + i->length()));
      std::istringstream lines(body);
      std::size_t values = 0, comments = 0;
      bool above = false;
      for (std::string line; std::getline(lines, line);) {
        if (std::regex_search(line, std::regex(R"re(^  [\w:]+ \w+ =)re"))) {
          ++values;
          comments += above ? 1 : 0;
        }
        if (line.find("///<") != std::string::npos) ++comments;
        above = std::regex_search(line, std::regex("^  ///(?!<)"));
      }
      CHECK(values > 0);
      CHECK(comments == values);
    }
  CHECK(structs > 18);
}
