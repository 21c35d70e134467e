// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include "finding_notes.hpp"

#include <thermopower/gap/reason.hpp>
#include <thermopower/gap/verdict.hpp>
#include <thermopower/io/compare_reports.hpp>
#include <thermopower/io/explain.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/io/sentences.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

std::string unwrapped(const std::string& text) { return std::regex_replace(text, std::regex("\n +"), " "); }

Diagnosis explained(double tempco, double half) {
  Diagnosis d;
  d.verdict = Verdict::explained;
  d.why = Reason::cause_explains;
  d.reason = to_string(d.why);
  d.cause.push_back(
      {"winding_tempco", 0.98, {{"tempco_per_K", tempco, {tempco - half, tempco + half}, "1/K"}}});
  d.gap.push_back({Signal::current_A, "A", std::nullopt, 0.06, 0.025, 0.004, 0.004, 1.0, 0.93, {0.87, 0.96}});
  d.gap.push_back({Signal::motor_C, "degC", std::nullopt, 3.4, 0.8, 0.1, 0.1, 1.0, 0.97, {0.92, 0.98}});
  d.constants.push_back({"conductance", 0.11, 0.11, {0.105, 0.115}, 0.05});
  return d;
}

}  // namespace

TEST_CASE("every effect, finding, verdict and reason has a page, under the same headings") {
  const std::vector<std::string> known = io::known_codes();
  const std::set<std::string> codes(known.begin(), known.end());
  CHECK(codes.size() == known.size());
  for (const EffectInfo& effect : standard_catalogue().list()) {
    CAPTURE(effect.id);
    const auto page = io::code_page(effect.id);
    REQUIRE(page.has_value());
    CHECK(page->sections.size() >= 7);  // and the equation
    CHECK(page->sections.front().heading == "Meaning");
    // What it is and how to see it come from the effect's own struct.
    CHECK_THAT(page->sections[0].text, ContainsSubstring(effect.prose.substr(1, effect.prose.size() - 2)));
    CHECK_THAT(page->sections[3].text, ContainsSubstring(effect.experiment.substr(1)));
  }
  const auto& findings = io::finding_notes();
  REQUIRE(findings.size() == static_cast<std::size_t>(FindingKind::no_final_line_break) + 1);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    CHECK(findings[i].kind == static_cast<FindingKind>(i));
    CHECK(io::code_page(to_string(findings[i].kind))->sections.size() == 6);
  }
  for (int i = 0; i <= static_cast<int>(Verdict::insufficient); ++i)
    CHECK(codes.count(to_string(static_cast<Verdict>(i))) == 1);
  for (int i = 0; i <= static_cast<int>(Reason::simulation_runs_away); ++i)
    CHECK(codes.count(code_of(static_cast<Reason>(i))) == 1);
  CHECK(io::code_page("calibration.inertia").has_value());
  CHECK_FALSE(io::code_page("no_such_thing").has_value());
}

TEST_CASE("an effect of one's own has a page from its struct") {
  EffectInfo own = standard_catalogue().list().front();
  own.id = "stiffening_hose";
  own.prose = "A hose stiffens in the cold.";
  own.experiment = "the same motion cold and warm";
  const auto page = io::code_page("stiffening_hose", {own});
  REQUIRE(page.has_value());
  CHECK_THAT(io::to_text(*page), ContainsSubstring("A hose stiffens in the cold.") &&
                                     ContainsSubstring("The same motion cold and warm."));
}

TEST_CASE("no line of a page is longer than the screen, and the documentation has the same words") {
  for (const std::string& code : io::known_codes()) {
    std::istringstream lines(io::to_text(*io::code_page(code)));
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 100);
  }
  std::ifstream file(THERMOPOWER_CODES_PAGE, std::ios::binary);
  std::string page((std::istreambuf_iterator<char>(file)), {});
  if (std::getenv("THERMOPOWER_UPDATE_DOCS") != nullptr) {
    const std::string begin = "explain --markdown: begin -->\n",
                      end = "<!-- from thermopower-gap explain --markdown: end";
    const std::size_t from = page.find(begin), to = page.find(end);
    REQUIRE((from != std::string::npos && to != std::string::npos));
    page = page.substr(0, from + begin.size()) + "\n" + io::code_pages_markdown() + page.substr(to);
    std::ofstream(THERMOPOWER_CODES_PAGE, std::ios::binary) << page;
  }
  // Mended by THERMOPOWER_UPDATE_DOCS=1 in the environment of this test.
  CHECK_THAT(page, ContainsSubstring(io::code_pages_markdown()));
}

TEST_CASE("the answer in words says what is missing, how large it is and what it is worth") {
  CHECK(io::sentences(explained(0.00393, 0.00005)) ==
        std::vector<std::string>{
            "The winding's resistance rises with temperature (0.393 % per K [0.388, 0.398]); the "
            "simulation had it constant.",
            "Adding it removes 93 % of the current error and 97 % of the temperature error; the rest "
            "is what noise makes."});
  // Brackets of the effect's own are not doubled, and a name without its unit stands before its number.
  Diagnosis d = explained(0.004, 1e-4);
  d.cause = {{"thermometer_gain", 0.9, {{"gain", 0.85, {0.84, 0.86}, "1"}}}};
  CHECK_THAT(io::sentences(d).front(),
             ContainsSubstring("(a wrong emissivity, a poor contact; gain 0.850 [0.840, 0.860])."));
  d.cause = {{"calibration.inertia", 0.9, {{"calibration.inertia.scale", 2.98, {2.95, 3.01}, "1"}}}};
  CHECK(io::sentences(d).front() ==
        "The inertia is not what the model says: the recording asks for 2.98 times that [2.95, 3.01].");
  // Numbers that the data do not tell are left to the list below, unless there is no other.
  d.cause = {
      {"coulomb_friction", 0.9, {{"Nm", 0.012, {0.011, 0.013}, "N m"}, {"tail", -1.0, {-5.0, 5.0}, "1"}}}};
  d.cause[0].parameters[1].told = false;
  CHECK_THAT(io::sentences(d).front(),
             ContainsSubstring("(0.0120 N m [0.0110, 0.0130])") && !ContainsSubstring("tail"));
  d.cause[0].parameters[0].told = false;
  CHECK_THAT(io::sentences(d).front(), ContainsSubstring("which these data do not tell"));
  d.cause = {{"calibration.inertia", 0.9, {{"calibration.inertia.scale", 2.98, {2.95, 3.01}, "1"}}}};
  d.gap[1].shrunk_by = -0.03;
  CHECK_THAT(io::sentences(d)[1],
             ContainsSubstring("Correcting it removes 93 % of the current error and raises the "
                               "temperature error by 3 %"));
  // An interval is told with the digits that tell its ends apart.
  CHECK(io::in_people_units({"lag_s", 25.0, {24.99, 25.01}, "s"}) == "lag 25.0 s [24.99, 25.01]");
}

TEST_CASE("the answer as Markdown is a table and sentences, and what is typed in it stays text") {
  const std::string text =
      io::summary_markdown(explained(0.00393, 0.00005), "arm_2 | left", {},
                           {"/home/somebody/model.json", {"a.csv"}, {}, {"--horizon 0.2"}, "2026-03-01"});
  CHECK_THAT(text, ContainsSubstring("### Sim-to-real gap of arm\\_2 \\| left: EXPLAINED") &&
                       ContainsSubstring(
                           "| motor current / A | 0.0600 | 0.0250 | 0.00400 | 0.00400 | 93 % [87, 96] |") &&
                       ContainsSubstring("- **Which:** `winding_tempco`, probability 98 %") &&
                       ContainsSubstring("Held out: the end of each recording. Options: --horizon 0.2.") &&
                       ContainsSubstring("Model model.json.") && !ContainsSubstring("somebody") &&
                       ContainsSubstring("2026-03-01"));
}

TEST_CASE("two reports are compared by what their uncertainties say") {
  const io::NamedReport before = {"before.json", io::report_json(explained(0.00393, 0.00005))};
  const std::string same =
      unwrapped(io::comparison(before, {"again.json", io::report_json(explained(0.00395, 0.00005))}));
  CHECK_THAT(same, ContainsSubstring("no difference beyond their errors") &&
                       ContainsSubstring("Both say the same."));
  const std::string other =
      unwrapped(io::comparison(before, {"after.json", io::report_json(explained(0.0043, 0.00005))}));
  CHECK_THAT(other, ContainsSubstring("after.json: explained by winding_tempco") &&
                        ContainsSubstring("they differ, by 10 standard deviations"));
  Diagnosis none;
  none.verdict = Verdict::no_gap;
  none.gap = explained(0.004, 1e-4).gap;
  none.gap[1].before = 0.12;
  const std::string gone = unwrapped(io::comparison(before, {"fixed.json", io::report_json(none)}));
  CHECK_THAT(gone, ContainsSubstring("only A      winding_tempco") &&
                       ContainsSubstring("fixed.json: no gap") && ContainsSubstring("3.40 -> 0.120"));
}

TEST_CASE("what is no report is refused by its name") {
  const io::NamedReport good = {"a.json", io::report_json(explained(0.004, 1e-4))};
  const auto fault = [&](const std::string& text) {
    try {
      io::comparison(good, {"b.json", text});
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(fault("t_s,x\n"), ContainsSubstring("expected a report that 'diagnose --report' wrote"));
  CHECK_THAT(fault("[]"), ContainsSubstring("b.json: /format is missing; expected thermopower-gap-report/1"));
  CHECK_THAT(fault(R"({"format": "thermopower-model/1"})"),
             ContainsSubstring("b.json: /format is thermopower-model/1"));
  CHECK_THAT(fault(R"({"format": "thermopower-gap-report/1"})"),
             ContainsSubstring("b.json: /verdict: is missing"));
  // A value of another kind is named by its place and line; a comparison never leaves it out in silence.
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good.text;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return fault(text.replace(at, from.size(), to));
  };
  CHECK_THAT(changed("\"explained\"", "3"),
             ContainsSubstring("b.json: /verdict: is 3; expected a verdict such as explained (line 3)"));
  CHECK_THAT(changed("\"explained\"", "\"perhaps\""),
             ContainsSubstring("/verdict: is \"perhaps\"; expected"));
  CHECK_THAT(changed("\"effect\": \"winding_tempco\"", "\"effect\": 1"),
             ContainsSubstring("/cause/0/effect: is 1; expected text"));
  CHECK_THAT(changed("\"before\": 0.06", "\"before\": \"0.06\""),
             ContainsSubstring("/gap/current_A/before: is \"0.06\"; expected a number or null"));
  CHECK_THAT(changed("\"before\": 0.06", "\"after\": 0.06"),
             ContainsSubstring("/gap/current_A/before: is missing"));
}
