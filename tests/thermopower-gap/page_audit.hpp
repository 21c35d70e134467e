// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "against_report.hpp"

#include <limits>

namespace printed {

/// All that people read on the page, besides the pictures.
class PageAudit : public AgainstReport {
public:
  explicit PageAudit(const Written& written) : AgainstReport(written) {
    std::string html = written.page;
    for (const char* no_text : {"script", "style", "svg", "title"}) cut_out(html, no_text);
    // Ticks of a picture, and the names of runs over it.
    take_all(html, "<div class=\"plot\"[^>]*>[^]*?</div>", [](const std::smatch&) {});
    take_all(html, "<h3>[^]*?</h3>", [](const std::smatch&) {});
    take_all(html, "<footer>[^]*?</footer>", [](const std::smatch&) {});
    std::size_t at = 0;
    for (bool first = true; at < html.size(); first = false) {
      const std::size_t end = std::min(html.find("<h2>", at + 1), html.size());
      std::string part = html.substr(at, end - at), title;
      at = end;
      const std::size_t closed = part.find("</h2>");
      if (!first) title = part.substr(4, closed - 4), part = part.substr(closed + 5);
      section(first ? "head" : title, part);
      // What is left is said without numbers, or nobody knows what stands behind them.
      for (const std::string& line : lines_of(without_tags(part))) {
        Sentence sentence(line);
        common(sentence);
        nothing_left(sentence);
      }
    }
    need(rows_ == r_["gap"].size(), "rows of the table");
    need(places_ == r_["where"].size(), "places on the page");
    need(causes_ == r_["cause"].size(), "causes on the page");
    need(rests_ == (r_.contains("remaining") ? 1u : 0u), "a rest on the page");
    need(not_judged_ == r_["not_judged"].size(), "what is not judged, on the page");
    need(experiments_ == (of(r_["next_experiment"]).empty() ? 0u : 1u), "the experiment on the page");
  }

private:
  using Match = std::function<void(const std::smatch&)>;

  static void cut_out(std::string& html, const std::string& tag) {
    for (std::size_t at = 0; (at = html.find("<" + tag, at)) != std::string::npos;) {
      const std::string end = "</" + tag + ">";
      const std::size_t to = html.find(end, at);
      html.erase(at, to == std::string::npos ? to : to + end.size() - at);
    }
  }

  /// Cuts every match out and has it looked at.
  static void take_all(std::string& html, const std::string& pattern, const Match& look) {
    const std::regex expression(pattern);
    std::string rest;
    std::smatch m;
    while (std::regex_search(html, m, expression)) {
      look(m);
      rest += m.prefix();
      html = m.suffix();
    }
    html = rest + html;
  }

  /// What stands on every page.
  static void common(Sentence& sentence) {
    sentence.take("(0 to 255)");        // the power's scale
    sentence.take("95 % interval");     // of the points of a picture
    sentence.take("Above 0.95 the");    // what the table of explanations means by alike
    sentence.take("Near 1 or -1 the");  // what a correlation is
  }

  static std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells;
    for (std::size_t at = 0, end; (end = row.find("</td>", at)) != std::string::npos; at = end + 5)
      cells.push_back(without_tags(row.substr(at, end - at)));
    return cells;
  }

  void section(const std::string& title, std::string& html) {
    take_all(html, "<div class=\"finding [^]*?</div>", [&](const std::smatch& m) {
      Sentence sentence(replaced(without_tags(m[0]), "\n", " "));
      finding(sentence);
      nothing_left(sentence);
    });
    if (title == "head") head(html);
    else if (title == "How far") how_far(html);
    else if (title == "Next experiment" || title == "What to do") next(html);
    else if (title == "Measured and simulated") runs(html);
    else if (title == "The missing quantity") missing(html);
    else if (title == "Where") where(html);
    else if (title == "Which") which(html);
    else if (title == "Constants") constants(html);
    else if (title == "What the estimates have in common") correlations(html);
    else if (title == "About the data") not_judged(html);
    else need(title == "What is left", "a section that nobody knows", title);
  }

  void head(std::string& html) {
    static const std::map<std::string, std::string> headlines = {
        {"no_gap", "Simulation and recording agree"},
        {"explained", "The gap is explained"},
        {"partial", "The gap is explained in part"},
        {"ambiguous", "Several explanations fit, and this recording cannot tell them apart"},
        {"unexplained",
         "There is a gap that no known effect explains|The simulation runs away|"
         "Refitted constants take a part of the gap away, and no known effect the rest"},
        {"insufficient", "(The data cannot be believed as they stand|Too little data for any statement)"}};
    bool said = false;
    take_all(html, "<h1 class=\"([a-z_]+)\">([^<]*)</h1>", [&](const std::smatch& m) {
      said = m[1] == verdict_word() && std::regex_match(m[2].str(), std::regex(headlines.at(verdict_word())));
    });
    need(said, "another verdict on the page");
    take_all(html, "<div class=\"eyebrow\">[^]*?</div>", [](const std::smatch&) {});  // the model's name
    take_all(html, "<p class=\"lead\">([^]*?)</p>", [&](const std::smatch& m) {
      need(without_tags(m[1]) == with_signs(capital(of(r_["reason"]))) + ".", "another reason", m[1]);
    });
    bool worded = false;
    take_all(html, "<p class=\"words\">([^]*?)</p>", [&](const std::smatch& m) {
      std::string words;
      for (const auto& one : r_["words"]) words += (words.empty() ? "" : " ") + of(one);
      worded = without_tags(m[1]) == with_signs(words);
      need(worded, "other words", m[1]);
    });
    need(worded, "no words");
    take_all(html, "<p class=\"from\">[^]*?</p>", [](const std::smatch&) {});  // versions and dates
    std::size_t cause = 0;
    take_all(
        html,
        "<div class=\"fact\"><span class=\"name\">([^]*?)</span><b>([^]*?)</b><span class=\"more\">([^]*?)</span></div>",
        [&](const std::smatch& m) {
          const std::string name = decoded(m[1]);
          Sentence sentence(name + "\n" + without_tags(m[2]) + "\n" + without_tags(m[3]));
          if (name == "Where" && !r_["where"].empty()) place(sentence, r_["where"][0]);
          else if (name.rfind("Which", 0) == 0 && cause < r_["cause"].size())
            which_fact(sentence, r_["cause"][cause++]);
          else if (name == "Or") alternatives(sentence);
          else if (name == "How far it shrinks") shrinks(sentence);
          else if (name == "How large") how_large(sentence);
          else if (name == "What remains" && r_.contains("remaining")) ++rests_, remaining(sentence);
          else complain("a fact that nobody knows", sentence.text());
          nothing_left(sentence);
        });
    causes_ = cause;
  }

  void which_fact(Sentence& sentence, const Json& cause) {
    need(sentence.text().find(of(cause["effect"])) != std::string::npos, "another cause", sentence.text());
    const int said = sentence.take(std::string("probability ") + share, [&](const std::smatch& m) {
      need(is_share(m[1], cause["probability"]), "another probability", sentence.text());
    });
    need(said == 1, "a probability that is not told", sentence.text());
    parameters(sentence, cause["parameters"], " ");
  }

  void alternatives(Sentence& sentence) {
    for (const auto& one : r_["alternatives"])
      need(sentence.take(together(one)), "an alternative that is not told", together(one));
  }

  /// The signal that a fact is of.
  const Json* named(const Sentence& sentence) const {
    const Json* found = nullptr;
    std::size_t longest = 0;
    for (const auto& [signal, gap] : r_["gap"].items())
      for (const char* after : {": ", ", RMS"})
        if (sentence.text().find("\n" + words(signal) + after) != std::string::npos &&
            words(signal).size() > longest)
          found = &gap, longest = words(signal).size();
    return found;
  }

  void shrinks(Sentence& sentence) {
    const Json* gap = named(sentence);
    need(gap != nullptr, "no signal's", sentence.text());
    if (gap == nullptr) return;
    int said = sentence.take(
        std::string(share) + " \\[" + number + ", " + number + "\\]", [&](const std::smatch& m) {
          need(is_share(m[1], (*gap)["shrunk_by"]) && is(m[2], 100.0 * (*gap)["ci95"][0].get<double>()) &&
                   is(m[3], 100.0 * (*gap)["ci95"][1].get<double>()),
               "another shrinkage", sentence.text());
        });
    said += sentence.take(
        std::string(": ") + number + " to " + number + "(?: [^,]+)?, noise floor " + number,
        [&](const std::smatch& m) {
          need(is(m[1], (*gap)["before"]) && is(m[2], (*gap)["after"]) && is(m[3], (*gap)["noise_floor"]),
               "another score", sentence.text());
        });
    need(said == 2, "a score that is not told", sentence.text());
    need(sentence.take("reaches below 0:") == ((*gap)["ci95"][0].get<double>() < 0.0),
         "where the interval reaches", sentence.text());
  }

  void how_large(Sentence& sentence) {
    const Json* gap = named(sentence);
    need(gap != nullptr, "no signal's", sentence.text());
    if (gap == nullptr) return;
    int said = sentence.take(std::string("noise floor ") + number, [&](const std::smatch& m) {
      need(is(m[1], (*gap)["noise_floor"]), "another floor", sentence.text());
    });
    said += sentence.take(std::string("^How large\n") + number, [&](const std::smatch& m) {
      need(is(m[1], (*gap)["before"]), "another score", sentence.text());
    });
    need(said == 2, "a score that is not told", sentence.text());
  }

  void how_far(std::string& html) {
    const bool caused = !r_["cause"].empty();
    take_all(
        html,
        "<tr class=\"name\"><td[^>]*>([^<]*)<span class=\"soft\">([^<]*)</span>[^]*?</tr>\\s*<tr>([^]*?)</tr>",
        [&](const std::smatch& m) {
          const Json* gap = nullptr;
          for (const auto& [signal, one] : r_["gap"].items())
            if (capital(words(signal)) == decoded(m[1])) gap = &one;
          need(gap != nullptr, "a row that nobody knows", m[1]);
          if (gap == nullptr) return;
          ++rows_;
          Sentence windows(decoded(m[2]));
          const int said =
              windows.take(std::string("windows of ") + number + " s", [&](const std::smatch& w) {
                need(!(*gap)["horizon_s"].is_null() && is(w[1], (*gap)["horizon_s"]), "another horizon",
                     w[0]);
              });
          need(said == ((*gap)["horizon_s"].is_null() ? 0 : 1), "a horizon that is not told", m[1]);
          nothing_left(windows);
          std::string row;
          for (const std::string& cell : cells_of(m[3])) row += "|" + replaced(cell, "\n", " ");
          Sentence sentence(row);
          std::string pattern = std::string("^\\|") + number + "\\|" + number +
                                (caused ? std::string("\\|") + number : "") + "\\|" + number;
          if (caused) pattern += std::string("\\|") + share + " \\[" + number + ", " + number + "\\]";
          const int scores = sentence.take(pattern + "$", [&](const std::smatch& s) {
            bool same = is(s[1], (*gap)["before"]) && is(s[2], (*gap)["recalibrated"]) &&
                        is(s[caused ? 4 : 3], (*gap)["noise_floor"]);
            if (caused)
              same = same && is(s[3], (*gap)["after"]) && is_share(s[5], (*gap)["shrunk_by"]) &&
                     is(s[6], 100.0 * (*gap)["ci95"][0].get<double>()) &&
                     is(s[7], 100.0 * (*gap)["ci95"][1].get<double>());
            need(same, "another score", row);
          });
          need(scores == 1, "a row that cannot be read", row);
        });
    bool told = false;
    take_all(html, "<p>([^]*?)</p>", [&](const std::smatch& m) {
      told = without_tags(m[1]) == with_signs(capital(of(r_["recalibration"]))) + ".";
      need(told, "another recalibration", m[1]);
    });
    need(told != of(r_["recalibration"]).empty(), "a recalibration that is not told");
  }

  void next(std::string& html) {
    take_all(html, "<p class=\"next\">([^]*?)</p>", [&](const std::smatch& m) {
      ++experiments_;
      need(without_tags(m[1]) == trimmed(of(r_["next_experiment"])), "another experiment", m[1]);
    });
  }

  /// A run's scores: the table's is a mean of them.
  void runs(std::string& html) {
    std::vector<std::vector<std::pair<std::string, std::string>>> scores;
    take_all(html, "<tr><td class=\"t\">[^]*?</td><td class=\"wide\">([0-9]+)</td>([^]*?)</tr>",
             [&](const std::smatch& m) {
               scores.emplace_back();
               for (const std::string& cell : cells_of(m[2])) {
                 const std::size_t arrow = cell.find(" \u2192 ");
                 if (arrow == std::string::npos) scores.back().emplace_back("\u2013", "\u2013");
                 else scores.back().emplace_back(cell.substr(0, arrow), cell.substr(arrow + 5));
               }
             });
    bool more = false;
    take_all(html, "<p class=\"soft\">[0-9]+ more runs were judged.</p>",
             [&](const std::smatch&) { more = true; });
    const char* const second = r_["cause"].empty() ? "recalibrated" : "after";
    std::size_t k = 0;
    for (const auto& [signal, gap] : r_["gap"].items()) {
      if (!scores.empty() && !more)
        between(scores, k, false, gap["before"], signal), between(scores, k, true, gap[second], signal);
      ++k;
    }
    take_all(html, "Drawn are the ([0-9]+) runs in which", [&](const std::smatch& m) {
      need(static_cast<std::size_t>(std::atoi(m[1].str().c_str())) <= scores.size(),
           "more runs than there are", m[0]);
    });
    take_all(html, std::string("from ") + number + "(?: |\u00a0)s on the fault shows",
             [&](const std::smatch& m) {
               bool known = false;
               for (const auto& one : r_["where"])
                 if (one.contains("only_in"))
                   for (const auto& run : one["only_in"])
                     known = known || (!run["from_s"].is_null() && is(m[1], run["from_s"]));
               need(known, "another stamp", m[0]);
             });
    take_all(html, std::string("Shown: ") + number + "(?: |\u00a0)s of " + number + "(?: |\u00a0)s",
             [&](const std::smatch& m) {
               const double shown = std::atof(m[1].str().c_str()), whole = std::atof(m[2].str().c_str());
               need(shown < whole && whole < 1.01 * w_.longest_run_s, "a longer run than any", m[0]);
             });
    take_all(html, "<div class=\"keys\">[^]*?</div>", [&](const std::smatch& m) {
      Sentence sentence(replaced(without_tags(m[0]), "\n", " "));
      common(sentence);
      nothing_left(sentence);
    });
  }

  void between(const std::vector<std::vector<std::pair<std::string, std::string>>>& scores, std::size_t k,
               bool second, const Json& value, const std::string& signal) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const auto& row : scores) {
      if (k >= row.size()) return complain("a run without its score", signal);
      const std::string& text = second ? row[k].second : row[k].first;
      if (text == "\u2013") continue;
      least = std::min(least, std::strtod(text.c_str(), nullptr));
      most = std::max(most, std::strtod(text.c_str(), nullptr));
    }
    const double mean = value;
    need(mean >= 0.995 * least && mean <= 1.005 * most, "the runs' scores are all on one side of the table's",
         signal);
  }

  void missing(std::string& html) {
    take_all(html, std::string("a smoothing spline with ") + number + " degrees of freedom",
             [&](const std::smatch& m) {
               need(std::atof(m[1].str().c_str()) >= 1.9, "fewer degrees of freedom than a straight line",
                    m[0]);
             });
  }

  void where(std::string& html) {
    take_all(html, "<div class=\"where\">([^]*?)</div>", [&](const std::smatch& m) {
      if (places_ >= r_["where"].size()) return complain("more places than there are");
      const Json& one = r_["where"][places_++];
      Sentence sentence(replaced(without_tags(m[1]), "\n", " "));
      const std::string evidence = with_signs(capital(of(one["evidence"])));
      need(sentence.text().find(evidence) != std::string::npos, "other evidence", sentence.text());
      Sentence before(trimmed(sentence.text().substr(0, sentence.text().find(evidence))));
      place(before, one);
      nothing_left(before);
    });
  }

  bool is_chosen(const Json& effects) const {
    if (effects.size() != r_["cause"].size() || effects.empty()) return false;
    return std::all_of(r_["cause"].begin(), r_["cause"].end(), [&](const Json& cause) {
      return std::find(effects.begin(), effects.end(), cause["effect"]) != effects.end();
    });
  }

  void which(std::string& html) {
    std::size_t at = 0;
    const std::size_t shown = std::min<std::size_t>(12, r_["ranking"].size());
    std::vector<Json> likeliest(r_["ranking"].begin(), r_["ranking"].end());
    std::stable_sort(likeliest.begin(), likeliest.end(), [](const Json& a, const Json& b) {
      const auto of_it = [](const Json& one) {
        return one["probability"].is_null() ? -1.0 : one["probability"].get<double>();
      };
      return of_it(a) > of_it(b);
    });
    take_all(
        html, "<tr[^>]*><td class=\"t\">([^]*?)</td><td class=\"t nowrap\">([^]*?)</td><td>([^]*?)</td></tr>",
        [&](const std::smatch& m) {
          const std::string probability = without_tags(m[2]);
          if (without_tags(m[1]) == "none of these") {
            need(is_share(probability, r_["none_of_these"]), "another probability",
                 "none of these " + probability);
            return;
          }
          if (at >= shown) return complain("more explanations than there are", m[1]);
          const Json& one = likeliest[at++];
          need(is_share(probability, one["probability"]), "another probability", together(one["effects"]));
          const std::string ratio = without_tags(m[3]);
          const double meant = one["held_out_ratio"].is_null() ? 0.0 : one["held_out_ratio"].get<double>();
          need(meant > 0.0 ? is_share(ratio, 1.0 - meant) : ratio == "\u2013", "another ratio",
               together(one["effects"]) + " " + ratio);
          explanation(one, lines_of(without_tags(m[1])));
        });
    need(at == shown, "explanations on the page");
    take_all(html, "<p class=\"soft\">([0-9]+) more were weighed", [&](const std::smatch& m) {
      need(is(m[1], r_["ranking"].size() - shown), "another count", m[0]);
    });
  }

  void explanation(const Json& one, const std::vector<std::string>& lines) {
    const std::string ids = one["effects"].empty() ? "nothing is missing" : together(one["effects"]);
    need(!lines.empty() && lines[0] == ids, "another explanation", ids);
    static const std::map<std::string, std::string> told = {
        {"nothing", ""},
        {"room", "a parameter ended on its bound"},
        {"a_judgement", "the training data rule it out"},
        {"use", "held-out data gets worse with it"},
        {"told_parameter", "the data leave one of its parameters open"},
        {"presence", "one of its causes may as well be absent"},
        {"something_own", "another explanation says the same with less"},
        {"difference", "refitted constants imitate it: this recording cannot show it"}};
    for (const auto& [id, words] : told)
      if (!words.empty())
        need((std::find(lines.begin(), lines.end(), words) != lines.end()) == (one["lacks"] == id),
             "what an explanation lacks is not told, or another", ids);
    need(told.count(one["lacks"].get<std::string>()) == 1, "a word for what is lacking that is none", ids);
    std::string numbers;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const bool prose = i == 1 && one["effects"].size() == 1 && lines[i].find(" = ") == std::string::npos &&
                         lines[i].rfind("looks like", 0) != 0;  // of the catalogue: says what it is
      if (!prose) numbers += "\n" + lines[i];
    }
    Sentence sentence(numbers);
    if (is_chosen(one["effects"])) parameters(sentence, one["parameters"], " = ");
    const std::size_t alike = std::min<std::size_t>(3, one["confusable"].size());
    for (std::size_t i = 0; i < alike; ++i) {
      const Json& other = one["confusable"][i];
      const std::string pattern =
          std::string("(?:looks like |, )") + literal(together(other["effects"])) + " \\(" + number + "\\)";
      const int said = sentence.take(
          pattern, [&](const std::smatch& m) { need(is(m[1], other["cosine"]), "another likeness", m[0]); });
      need(said == 1, "a likeness that is not told once", together(other["effects"]));
    }
    nothing_left(sentence);
  }

  void constants(std::string& html) {
    std::size_t rows = 0;
    take_all(html, "<tr>(<td[^]*?)</tr>", [&](const std::smatch& m) {
      const std::vector<std::string> cells = cells_of(m[1]);
      if (cells.size() != 5 || !r_["constants"].contains(cells[0]))
        return complain("a constant that nobody knows", m[1]);
      ++rows;
      const Json& one = r_["constants"][cells[0]];
      const double moved = 100.0 * (one["fitted"].get<double>() / one["configured"].get<double>() - 1.0);
      need(is(cells[1], one["configured"]) && is(cells[2], one["fitted"]) &&
               is(cells[3].substr(0, cells[3].find(' ')), moved) &&
               is_share(cells[4].substr(cells[4].find(' ') + 1), one["uncertainty"]),
           "another constant", m[1]);
    });
    need(rows == r_["constants"].size(), "constants on the page");
  }

  void correlations(std::string& html) {
    const Json& names = r_["correlation"]["names"];
    std::vector<std::size_t> order;
    take_all(html, "<tr>(<td[^]*?)</tr>", [&](const std::smatch& m) {
      const std::vector<std::string> cells = cells_of(m[1]);
      const std::size_t space = cells.empty() ? std::string::npos : cells[0].find(' ');
      const auto found = space == std::string::npos
                             ? names.end()
                             : std::find(names.begin(), names.end(), cells[0].substr(space + 1));
      if (found == names.end()) return complain("a parameter that nobody knows", m[1]);
      order.push_back(static_cast<std::size_t>(found - names.begin()));
      need(cells[0].substr(0, space) == std::to_string(order.size()), "another number of a row", cells[0]);
      for (std::size_t k = 0; k < order.size() && k + 1 < cells.size(); ++k)
        need(is(cells[k + 1], r_["correlation"]["of"][order.back()][order[k]]), "another correlation",
             cells[0]);
    });
    need(order.size() == std::min<std::size_t>(8, names.size()), "rows of correlations");
    take_all(html, "<p class=\"soft\">([0-9]+) more constants", [&](const std::smatch& m) {
      need(is(m[1], names.size() - order.size()), "another count", m[0]);
    });
    std::size_t column = 0;
    take_all(html, "<th>([0-9]+)</th>", [&](const std::smatch& m) {
      need(m[1] == std::to_string(++column), "another number of a column", m[0]);
    });
  }

  void not_judged(std::string& html) {
    take_all(html, "<li>([^]*?)</li>", [&](const std::smatch& m) {
      need(not_judged_ < r_["not_judged"].size() && without_tags(m[1]) == of(r_["not_judged"][not_judged_]),
           "something else that is not judged", m[1]);
      ++not_judged_;
    });
  }

  std::size_t rows_ = 0, places_ = 0, causes_ = 0, rests_ = 0, not_judged_ = 0, experiments_ = 0;
};

}  // namespace printed
