// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "against_report.hpp"

#include <utility>

namespace printed {

/// All that stands on the screen.
class ScreenAudit : public AgainstReport {
public:
  explicit ScreenAudit(const Written& written) : AgainstReport(written) { read(); }

private:
  void read() {
    std::vector<std::pair<std::string, std::string>> paragraphs;
    std::vector<std::string> rows;
    std::string headline;
    for (std::size_t at = 0; at < w_.screen.size();) {
      const std::size_t end = std::min(w_.screen.find('\n', at), w_.screen.size());
      const std::string line = w_.screen.substr(at, end - at);
      at = end + 1;
      if (trimmed(line).empty()) continue;
      if (headline.empty()) {
        headline = line;
      } else if (line.rfind("  RMSE", 0) == 0 || (!rows.empty() && line.find(" / ") != std::string::npos &&
                                                  rows.size() <= r_["gap"].size())) {
        rows.push_back(line);
      } else if (line.size() > 14 && line[2] != ' ') {
        paragraphs.emplace_back(trimmed(line.substr(0, 14)), trimmed(line.substr(14)));
      } else if (line.size() > 14) {
        // A sentence goes on, or the next one of a kind begins: only what was wrapped is as long as that.
        const bool first = paragraphs.empty();
        if (first || begins_anew(paragraphs.back().first, trimmed(line)))
          paragraphs.emplace_back(first ? "words" : paragraphs.back().first, trimmed(line));
        else paragraphs.back().second += " " + trimmed(line);
      }
    }
    static const std::map<std::string, std::string> headlines = {
        {"no_gap", "NO GAP"},       {"explained", "EXPLAINED"},     {"partial", "PARTLY EXPLAINED"},
        {"ambiguous", "AMBIGUOUS"}, {"unexplained", "UNEXPLAINED"}, {"insufficient", "INSUFFICIENT DATA"}};
    need(headline == headlines.at(verdict_word()), "another verdict", headline);
    std::map<std::string, std::size_t> count;
    for (const auto& [label, text] : paragraphs) {
      Sentence sentence(text);
      paragraph(label, count[label]++, sentence);
      nothing_left(sentence);
    }
    need(count["where"] == r_["where"].size(), "places on the screen");
    need(count["which"] == r_["cause"].size(), "causes on the screen");
    need(count["remaining"] == (r_.contains("remaining") ? 1u : 0u), "a rest on the screen");
    need(count["not judged"] == r_["not_judged"].size(), "what is not judged, on the screen");
    screen_table(rows);
  }

  /// Whether an indented line begins another entry of its kind.
  bool begins_anew(const std::string& label, const std::string& line) const {
    if (label == "where")
      return std::any_of(r_["where"].begin(), r_["where"].end(), [&](const Json& one) {
        return line.rfind(words(of(one["signal"])) + ", " + of(one["submodel"]) + " (", 0) == 0;
      });
    if (label == "which")
      return std::any_of(r_["cause"].begin(), r_["cause"].end(),
                         [&](const Json& one) { return line.rfind(of(one["effect"]) + " (", 0) == 0; });
    return false;
  }

  void paragraph(const std::string& label, std::size_t index, Sentence& sentence) {
    const std::string& text = sentence.text();
    if (label == "words") {
      std::string words;
      for (const auto& one : r_["words"]) words += (words.empty() ? "" : " ") + of(one);
      need(text == words, "other words", text);
      sentence.take(words);
    } else if (label == "why") {
      need(text == of(r_["reason"]), "another reason", text);
      sentence.take(of(r_["reason"]));
    } else if (label == "data" || label == "note") {
      finding(sentence);
    } else if (label == "where" && index < r_["where"].size()) {
      place(sentence, r_["where"][index]);
    } else if (label == "which" && index < r_["cause"].size()) {
      const Json& cause = r_["cause"][index];
      const int said = sentence.take(
          "^" + literal(of(cause["effect"])) + " \\(" + share + "\\)", [&](const std::smatch& m) {
            need(is_share(m[1], cause["probability"]), "another probability", text);
          });
      need(said == 1, "another cause", text);
      if (of(cause["effect"]).rfind("unknown.", 0) != 0)
        return parameters(sentence, cause["parameters"], " ");
      for (const auto& [name, one] : cause["parameters"].items()) {
        const std::string place = name.substr(name.rfind('_'));
        if (place == "_1") parameter(sentence, name, one, ": ", " at the low end of the range seen");
        if (place == "_10") parameter(sentence, name, one, ", ", " at the high end");
      }
    } else if (label == "with") {
      const int said =
          sentence.take(std::string("^(\\S+) ") + number + " -> " + number + " \\(known to " + share + "\\)$",
                        [&](const std::smatch& m) { constant(m[1], m[2], m[3], m[4]); });
      need(said == 1, "a constant that cannot be read", text);
    } else if (label == "remaining" && r_.contains("remaining")) {
      remaining(sentence);
    } else if (label == "or") {
      std::string others;
      for (const auto& one : r_["alternatives"]) others += (others.empty() ? "" : "; ") + together(one);
      need(text.rfind(others + " (", 0) == 0, "other alternatives", text);
    } else if (label == "rows") {
      bool any = false;
      for (const auto& one : r_["findings"]) any = any || !one["rows"].empty();
      need(any, "rows are counted where no finding has any", text);
      sentence.take("are counted from 0 ");  // what the format says of them
      sentence.take("row 0 is line 2");
    } else if (label == "constants") {
      need(text == of(r_["recalibration"]), "another recalibration", text);
      sentence.take(of(r_["recalibration"]));
    } else if (label == "next") {
      need(text == of(r_["next_experiment"]), "another experiment", text);
      sentence.take(of(r_["next_experiment"]));
    } else if (label == "not judged" && index < r_["not_judged"].size()) {
      need(text == of(r_["not_judged"][index]), "something else that is not judged", text);
      sentence.take(of(r_["not_judged"][index]));
    } else {
      complain("a paragraph that nobody knows", label + " " + text);
    }
  }

  void screen_table(const std::vector<std::string>& rows) {
    const bool caused = !r_["cause"].empty();
    need(rows.empty() ? r_["gap"].empty() : rows.size() == r_["gap"].size() + 1, "rows on the screen");
    need(rows.empty() || rows[0].find("shrunk by [95 %]") != std::string::npos, "another head of the table");
    for (const auto& [signal, gap] : r_["gap"].items()) {
      const std::string begins = "  " + words(signal) + " / " + of(gap["unit"]) + " ";
      int said = 0;
      for (const std::string& row : rows) {
        if (row.rfind(begins, 0) != 0) continue;
        Sentence sentence(row.substr(begins.size() - 1));
        said += scores(sentence, gap, caused);
        nothing_left(sentence);
      }
      need(said == 1, "a signal without one row on the screen", signal);
    }
  }

  int scores(Sentence& sentence, const Json& gap, bool caused) {
    const std::string pattern = caused
                                    ? std::string("^ +") + number + " +" + number + " +" + number + " +" +
                                          number + " +" + share + " \\[" + number + ", " + number + "\\]$"
                                    : std::string("^ +") + number + " +" + number + " +- +" + number + " +-$";
    return sentence.take(pattern, [&](const std::smatch& m) {
      bool same = is(m[1], gap["before"]) && is(m[2], gap["recalibrated"]) &&
                  is(m[caused ? 4 : 3], gap["noise_floor"]);
      if (caused)
        same = same && is(m[3], gap["after"]) && is_share(m[5], gap["shrunk_by"]) &&
               is(m[6], 100.0 * gap["ci95"][0].get<double>()) &&
               is(m[7], 100.0 * gap["ci95"][1].get<double>());
      need(same, "another score", sentence.text());
    });
  }
};

}  // namespace printed
