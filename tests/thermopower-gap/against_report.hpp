// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "printed_text.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace printed {

/// What a diagnosis wrote, and how long what it looked at was.
struct Written {
  Json report;                 ///< report.json
  std::string screen;          ///< standard output
  std::string page;            ///< the page
  double longest_run_s = 0.0;  ///< of all recordings
  bool one_held_out = true;    ///< there is one held-out recording
};

/// Holds sentences against report.json, which is what counts; what the audits of screen, page and evidence share.
class AgainstReport {
public:
  explicit AgainstReport(const Written& written) : w_(written), r_(written.report) {}

  /// What does not agree; empty where all does.
  const std::vector<std::string>& complaints() const { return complaints_; }

protected:
  void complain(const std::string& what, const std::string& text = {}) {
    complaints_.push_back(text.empty() ? what : what + ": " + text);
  }
  void need(bool holds, const std::string& what, const std::string& text = {}) {
    if (!holds) complain(what, text);
  }
  void nothing_left(const Sentence& sentence) {
    for (const std::string& one : sentence.left()) complain("nothing stands behind " + one, sentence.text());
  }

  static std::string words(const std::string& name) {
    static const std::map<std::string, std::string> known = {
        {"current_A", "motor current"}, {"motor_C", "motor temperature"}, {"angle_deg", "angle"},
        {"rate_dps", "angular rate"},   {"drive_A", "drive current"},     {"voltage_V", "voltage"}};
    const auto found = known.find(name);
    return found == known.end() ? name : found->second;
  }
  /// Units as the page spells them; a unit follows a number or an interval.
  static std::string with_signs(const std::string& text) {
    const std::pair<const char*, const char*> signs[] = {{"([0-9\\]]) degC\\b", "$1 \u00b0C"},
                                                         {"([0-9\\]]) ohm\\b", "$1 \u03a9"},
                                                         {"([0-9\\]]) deg/s\\b", "$1 \u00b0/s"},
                                                         {"([0-9\\]]) m\\^2\\b", "$1 m\u00b2"},
                                                         {"([0-9\\]]) rad/s2\\b", "$1 rad/s\u00b2"}};
    std::string out = text;
    for (const auto& [plain, sign] : signs) out = std::regex_replace(out, std::regex(plain), sign);
    return out;
  }
  static std::string of(const Json& text) { return text.get<std::string>(); }
  static std::string together(const Json& ids) {
    std::string out;
    for (const auto& id : ids) out += (out.empty() ? "" : " + ") + of(id);
    return out;
  }
  static std::string capital(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
  }
  /// In a pattern as it stands.
  static std::string literal(const std::string& text) {
    return std::regex_replace(text, std::regex("[-.^$|()\\[\\]{}*+?\\\\/]"), "\\$&");
  }
  const Json& gap_of(const std::string& signal) const { return r_["gap"][signal]; }
  std::string verdict_word() const { return of(r_["verdict"]); }

  /// A sentence for people calls what was recorded by words.
  void named_in_words(const std::string& text) {
    static const std::regex column(
        "\\b(t_s|power_param|drive_A|voltage_V|v_rms_V|target_deg|target_dps|torque_Nm|"
        "heat_W|supply_V|ambient_C|airspeed_mps|neighbour_C|current_A|motor_C|angle_deg|"
        "rate_dps|law_A|rise_K|dT_dt|servo_A|\\w+_per_s2?)\\b");
    static const std::regex of_data("^the data cannot be believed");  // that is about a column
    std::smatch found;
    if (!std::regex_search(text, of_data) && std::regex_search(text, found, column))
      complain("'" + found[0].str() + "' is no word", text);
  }

  void regime(Sentence& sentence, const Json& regime) {
    const std::string range = std::string("most for (.+?) ") + number + "(?: to " + number + ")?";
    const int said = sentence.take(range, [&](const std::smatch& m) {
      need(!regime.is_null() && is(m[2], regime["from"]) && is(m[3].matched ? m[3] : m[2], regime["to"]),
           "another regime", m[0]);
      named_in_words(m[1]);
    });
    need(said == (regime.is_null() ? 0 : 1), "a regime that is not told", sentence.text());
  }

  void occurrences(Sentence& sentence, const Json& place) {
    if (!place.contains("only_in")) return;
    for (const auto& one : place["only_in"]) {
      const std::string path = of(one["recording"]), name = path.substr(path.find_last_of('/') + 1);
      need(sentence.take(path) || sentence.take(name), "an occurrence that is not told", sentence.text());
      if (of(one["run"]).empty()) continue;
      need(sentence.take("run " + of(one["run"])), "a run that is not told", sentence.text());
    }
    std::vector<Json> stamps;
    for (const auto& one : place["only_in"])
      if (!one["from_s"].is_null()) stamps.push_back(one["from_s"]);
    std::size_t at = 0;
    sentence.take(std::string("from ") + number + " s on", [&](const std::smatch& m) {
      need(at < stamps.size() && is(m[1], stamps[at++]), "another stamp", m[0]);
    });
    need(at == stamps.size(), "a stamp that is not told", sentence.text());
  }

  void parameters(Sentence& sentence, const Json& list, const std::string& assigned) {
    for (const auto& [name, one] : list.items())
      parameter(sentence, name, one, "(?:^|[ ,:\n])" + literal(name) + assigned, "");
  }

  /// A value with its interval, between two patterns.
  void parameter(Sentence& sentence, const std::string& name, const Json& one, const std::string& before,
                 const std::string& after) {
    const auto is_nothing = [&](const std::smatch& m) {
      need(is(m[1], one["value"]), "another parameter", m[0]);
    };
    const auto is_interval = [&](const std::smatch& m) {
      need(is(m[1], one["value"]) && is(m[2], one["ci95"][0]) && is(m[3], one["ci95"][1]),
           "another parameter", m[0]);
    };
    const std::string begin = before + number;
    const int said =
        one.contains("told")
            ? sentence.take(begin + "(?: [^\\[(,]+)? \\(not told by these data\\)" + after, is_nothing)
            : sentence.take(begin + "(?: [^\\[,]+)? \\[" + number + ", " + number + "\\]" + after,
                            is_interval);
    need(said == 1, "a parameter that is not told once", name);
  }

  static bool takes_gap_away(const Json& place) { return !(place["share"].get<double>() < 0.005); }

  void constant(const std::string& name, const std::string& configured, const std::string& fitted,
                const std::string& known) {
    const bool there = r_["constants"].contains(name);
    need(there, "a constant that did not move", name);
    if (!there) return;
    const Json& one = r_["constants"][name];
    need(
        is(configured, one["configured"]) && is(fitted, one["fitted"]) && is_share(known, one["uncertainty"]),
        "another constant", name);
  }

  void place(Sentence& sentence, const Json& place) {
    need(sentence.text().find(words(of(place["signal"]))) != std::string::npos &&
             sentence.text().find(of(place["submodel"])) != std::string::npos,
         "another place", sentence.text());
    const int shares =
        sentence.take(std::string(share) + " of (?:the|its) (?:gap|difference)", [&](const std::smatch& m) {
          need(takes_gap_away(place) && is_share(m[1], place["share"]), "another share", sentence.text());
        });
    need(shares == (takes_gap_away(place) ? 1 : 0), "a share that is not told", sentence.text());
    if (verdict_word() == "no_gap")
      need(sentence.text().find(" gap") == std::string::npos, "there is no gap", sentence.text());
    regime(sentence, place["regime"]);
    occurrences(sentence, place);
  }

  void remaining(Sentence& sentence) {
    const Json& rest = r_["remaining"];
    sentence.take(of(rest["looks"]));
    sentence.take(capital(of(rest["looks"])));
    int said = sentence.take(std::string(number) + " times its noise floor", [&](const std::smatch& m) {
      need(is(m[1], rest["times_floor"]), "another rest", sentence.text());
    });
    said += sentence.take(std::string(share) + " of the gap", [&](const std::smatch& m) {
      need(is_share(m[1], rest["share"]), "another rest", sentence.text());
    });
    need(said == 2, "a rest that is not told", sentence.text());
    need(sentence.text().find(words(of(rest["signal"]))) != std::string::npos, "another signal",
         sentence.text());
    regime(sentence, rest["regime"]);
  }

  /// A finding is told as the report has it.
  bool finding(Sentence& sentence) {
    for (const auto& one : r_["findings"]) {
      const bool plain = sentence.text().find(of(one["message"])) != std::string::npos;
      if (!plain && sentence.text().find(with_signs(of(one["message"]))) == std::string::npos) continue;
      const std::string path = of(one["recording"]), name = path.substr(path.find_last_of('/') + 1);
      if (sentence.text().find(name) == std::string::npos) continue;
      sentence.take(plain ? of(one["message"]) : with_signs(of(one["message"])));
      sentence.take(of(one["mend"]));
      sentence.take(of(one["column"]));
      for (const auto& other : r_["findings"]) {  // the same fault of several recordings is told once
        const std::string& whole = other["recording"].get_ref<const std::string&>();
        sentence.take(whole);
        sentence.take(whole.substr(whole.find_last_of('/') + 1));
      }
      sentence.take("(?:Counted as missing|The run is cut there): ([0-9]+) rows?", [&](const std::smatch& m) {
        need(is(m[1], one["row_count"]), "another count of rows", m[0]);
      });
      return true;
    }
    complain("a finding that the report does not have", sentence.text());
    return false;
  }

  const Written& w_;
  const Json& r_;

private:
  std::vector<std::string> complaints_;
};

}  // namespace printed
