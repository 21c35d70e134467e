// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "against_report.hpp"

#include <set>

namespace printed {

/// Multiple of the noise floor up to which a report counts a signal as near it: docs/explain/gap-method.md.
constexpr double near_floor = 1.5;

/// What report.json says in words, against its own numbers.
class TableAudit : public AgainstReport {
public:
  explicit TableAudit(const Written& written) : AgainstReport(written) {
    verdict();
    table();
    places();
    rest();
    steps();
    in_words();
  }

private:
  bool above(const Json& gap) const {
    return gap["after"].get<double>() > near_floor * gap["noise_floor"].get<double>();
  }
  bool any_above() const {
    return std::any_of(r_["gap"].begin(), r_["gap"].end(), [&](const Json& one) { return above(one); });
  }

  /// The verdict and its reason against the table.
  void verdict() {
    const std::string word = verdict_word(), reason = of(r_["reason"]);
    const bool caused = !r_["cause"].empty();
    need(caused == (word == "explained" || word == "partial" || word == "ambiguous"),
         "causes do not fit the verdict", word);
    need((word == "ambiguous") == !r_["alternatives"].empty(), "alternatives do not fit the verdict", word);
    need((word == "insufficient") == r_["gap"].empty(), "a table does not fit the verdict", word);
    if (word == "explained") need(!any_above(), "explained, and the table is above the noise");
    if (word == "partial") need(any_above(), "in part, and the table is near the noise");
    if (caused && reason.find("near the noise") != std::string::npos)
      need(!any_above(), "'near the noise', and the table is above it", reason);
    if (reason.find("all the way") != std::string::npos || reason.find("remains") != std::string::npos ||
        reason.find("the rest stays above") != std::string::npos)
      need(any_above(), "a rest, and the table has none", reason);
    need(r_.contains("remaining") == (caused && any_above() && r_["verdict"] != "explained"),
         "what remains does not fit the table", word);
    if (word == "no_gap")
      for (const auto& gap : r_["gap"])
        need(std::min(gap["before"].get<double>(), gap["recalibrated"].get<double>()) <=
                 near_floor * gap["noise_floor"].get<double>(),
             "no gap, and the table shows one");
    if (word == "unexplained")
      need(std::any_of(r_["gap"].begin(), r_["gap"].end(),
                       [](const Json& gap) { return gap["before"] > gap["noise_floor"]; }),
           "a gap, and the table shows none");
    named_in_words(reason);
  }

  /// The table against itself, and what is said of its columns.
  void table() {
    std::string worse;
    for (const auto& [signal, gap] : r_["gap"].items()) {
      const double before = gap["before"], after = gap["after"];
      if (before > 0.0)
        need(std::fabs(1.0 - after / before - gap["shrunk_by"].get<double>()) < 1e-9, "shrunk_by", signal);
      if (!r_["cause"].empty())
        need(gap["ci95"][0] <= gap["shrunk_by"] && gap["shrunk_by"] <= gap["ci95"][1],
             "an interval without its value", signal);
      for (const auto& note : r_["not_judged"])
        need(of(note).rfind("the " + words(signal) + " is not judged", 0) != 0, "a row of what is not judged",
             of(note));
      const bool is_worse = gap["recalibrated"].get<double>() > 1.05 * before;
      const std::string said = words(signal) + ": refitted constants score ";
      need((of(r_["recalibration"]).find(said) != std::string::npos) == is_worse,
           "what recalibration does to held-out data", signal);
      if (!is_worse) continue;
      Sentence sentence(of(r_["recalibration"]));
      sentence.take(literal(said) + number + " times", [&](const std::smatch& m) {
        need(is(m[1], gap["recalibrated"].get<double>() / before), "recalibrated", sentence.text());
      });
    }
    named_in_words(of(r_["recalibration"]));
    double probability = r_["none_of_these"].is_null() ? 0.0 : r_["none_of_these"].get<double>();
    for (const auto& one : r_["ranking"])
      if (!one["probability"].is_null()) probability += one["probability"].get<double>();
    need(probability < 1.0 + 1e-6, "probabilities of more than 1");
    for (const auto& cause : r_["cause"])
      for (const auto& [name, parameter] : cause["parameters"].items())
        need(parameter["ci95"][0] <= parameter["value"] && parameter["value"] <= parameter["ci95"][1],
             "an interval without its value", name);
  }

  /// The evidence for each place against its share and against the recordings.
  void places() {
    std::set<std::string> seen;
    for (const auto& place : r_["where"]) {
      need(seen.insert(of(place["signal"]) + of(place["submodel"])).second, "a place that is named twice");
      const std::string evidence = of(place["evidence"]);
      named_in_words(evidence);
      Sentence sentence(evidence);
      double sum = 0.0;
      const int shares = sentence.take("explains ([0-9]+) % of the excess", [&](const std::smatch& m) {
        sum += 0.01 * std::atof(m[1].str().c_str());
      });
      need(std::fabs(std::min(sum, 1.0) - place["share"].get<double>()) <= 0.005 * shares + 1e-9,
           "the evidence explains another share", evidence);
      sentence.take(std::string("correlation ratio ") + number + ", by chance up to " + number,
                    [&](const std::smatch& m) {
                      const double ratio = std::atof(m[1].str().c_str()),
                                   chance = std::atof(m[2].str().c_str());
                      need(ratio >= chance && ratio <= 1.0, "a correlation that chance makes, too", evidence);
                    });
      // What a freedom found by itself has no table.
      sentence.take("repeats [0-9]+ times a turn", [](const std::smatch&) {});
      sentence.take(std::string("behind a spring, ") + number + " Hz", [](const std::smatch&) {});
      sentence.take(std::string("comes ") + number + " s after the temperature", [&](const std::smatch& m) {
        need(std::atof(m[1].str().c_str()) < w_.longest_run_s, "a lag longer than any run", evidence);
      });
      nothing_left(sentence);
      if (!place["regime"].is_null())
        need(place["regime"]["from"] <= place["regime"]["to"], "a regime that ends before it begins");
    }
  }

  static std::string signal_of_error(const std::string& error) {
    if (error == "current") return "current_A";
    if (error == "temperature") return "motor_C";
    if (error == "angle") return "angle_deg";
    if (error == "angular rate") return "rate_dps";
    return error;
  }

  /// Whether some parameter of the causes has these numbers; of a temperature coefficient in per cent.
  bool is_a_parameter(const std::string& value, const std::string& low, const std::string& high) const {
    for (const auto& cause : r_["cause"])
      for (const auto& [name, one] : cause["parameters"].items()) {
        const double times = one["unit"] == "1/K" ? 100.0 : 1.0;
        const auto same = [times](const std::string& text, const Json& number_of_it) {
          return number_of_it.is_null() ? is(text, number_of_it)
                                        : is(text, Json(times * number_of_it.get<double>()));
        };
        if (same(value, one["value"]) &&
            (low.empty() || (same(low, one["ci95"][0]) && same(high, one["ci95"][1]))))
          return true;
      }
    return false;
  }

  /// The answer in words against everything else.
  void in_words() {
    need(!r_["words"].empty(), "nothing is said in words");
    const std::string signal = "(current|temperature|angle|angular rate)",
                      the_signal = "(motor current|motor temperature|angle|angular rate)";
    for (const auto& text : r_["words"]) {
      Sentence sentence(of(text));
      sentence.take(of(r_["reason"]));
      sentence.take(capital(of(r_["reason"])));
      for (const auto& one : r_["findings"]) sentence.take(of(one["message"]));
      sentence.take(std::string(share) + " of the " + signal + " error", [&](const std::smatch& m) {
        need(is_share(m[1], gap_of(signal_of_error(m[2]))["shrunk_by"]), "another shrinkage in words",
             sentence.text());
      });
      sentence.take("the " + signal + " error by " + share, [&](const std::smatch& m) {
        need(is_share(m[2], Json(-gap_of(signal_of_error(m[1]))["shrunk_by"].get<double>())),
             "another growth in words", sentence.text());
      });
      sentence.take(std::string(number) + "(?: [^\\[(),]+)? \\[" + number + ", " + number + "\\]",
                    [&](const std::smatch& m) {
                      need(is_a_parameter(m[1], m[2], m[3]), "another parameter in words", sentence.text());
                    });
      sentence.take(std::string(number) + "(?: [^\\[(),]+)?, which these data do not tell",
                    [&](const std::smatch& m) {
                      need(is_a_parameter(m[1], "", ""), "another parameter in words", sentence.text());
                    });
      sentence.take(std::string(number) + " times that", [&](const std::smatch& m) {
        need(is_a_parameter(m[1], "", ""), "another factor in words", sentence.text());
      });
      sentence.take("the error of the " + the_signal + " is " + number + " times what noise makes",
                    [&](const std::smatch& m) {
                      need(is(m[2], r_["remaining"]["times_floor"]), "another rest in words",
                           sentence.text());
                    });
      sentence.take(std::string("off by ") + number + " \\S+ in the " + the_signal +
                        " \\(RMS\\), where noise makes " + number,
                    [&](const std::smatch& m) {
                      for (const auto& [name, gap] : r_["gap"].items())
                        if (words(name) == m[2])
                          need(is(m[1], gap["before"]) && is(m[3], gap["noise_floor"]),
                               "another gap in words", sentence.text());
                    });
      sentence.take(std::string("bring that down to ") + number, [&](const std::smatch& m) {
        need(std::any_of(r_["gap"].begin(), r_["gap"].end(),
                         [&](const Json& gap) { return is(m[1], gap["recalibrated"]); }),
             "another score in words", sentence.text());
      });
      const char* const predicted =
          of(r_["decision"]["reason"]) == "constants_within_known" ? "recalibrated" : "before";
      sentence.take("the " + the_signal + " to " + number + " \\S+ \\(noise makes " + number + "\\)",
                    [&](const std::smatch& m) {
                      for (const auto& [name, gap] : r_["gap"].items())
                        if (words(name) == m[1])
                          need(is(m[2], gap[predicted]) && is(m[3], gap["noise_floor"]),
                               "another score in words", sentence.text());
                    });
      sentence.take("or [0-9]+ more", [&](const std::smatch&) {});
      nothing_left(sentence);
    }
  }

  /// What rounding errs by: its steps over sqrt(12).
  void steps() {
    for (const auto& one : r_["findings"]) {
      if (one["kind"] != "coarse_quantum") continue;
      Sentence sentence(of(one["message"]));
      const int said = sentence.take(
          std::string("steps of ") + number + ": rounding alone errs by " + number + " \\(RMS\\)",
          [&](const std::smatch& m) {
            const double step = std::atof(m[1].str().c_str()), error = std::atof(m[2].str().c_str());
            need(std::fabs(error * std::sqrt(12.0) / step - 1.0) < 2e-3, "rounding errs by something else",
                 sentence.text());
          });
      need(said == 1, "steps without what rounding errs by", sentence.text());
    }
  }

  /// What remains, against the table.
  void rest() {
    if (!r_.contains("remaining")) return;
    const Json& rest = r_["remaining"];
    const Json& gap = gap_of(of(rest["signal"]));
    const double after = gap["after"], floor = gap["noise_floor"], before = gap["before"];
    need(std::fabs(rest["times_floor"].get<double>() - after / floor) < 1e-6 * after / floor, "times_floor");
    for (const auto& one : r_["gap"])
      need(one["after"].get<double>() / one["noise_floor"].get<double>() <= after / floor * (1.0 + 1e-9),
           "another signal is further above the noise");
    const double above = std::sqrt(std::max(after * after - floor * floor, 0.0)),
                 whole = std::sqrt(std::max(before * before - floor * floor, 0.0));
    if (whole > 0.0)
      need(std::fabs(rest["share"].get<double>() - std::min(1.0, above / whole)) < 1e-6, "share of the rest");
    named_in_words(of(rest["looks"]));
    Sentence sentence(of(rest["looks"]));
    sentence.take(
        std::string("alike for about ") + number + " s; ([0-9]+) % of them is a constant offset of " +
            number + " (\\S+)$",
        [&](const std::smatch& m) {
          const double offset = std::atof(m[3].str().c_str()), half = 0.05 * std::fabs(offset);
          need(std::atof(m[1].str().c_str()) < w_.longest_run_s, "errors alike for longer than a run", m[0]);
          need(m[4] == gap["unit"], "another unit", m[0]);
          if (!w_.one_held_out) return;
          const double part = 100.0 * offset * offset / (after * after),
                       wide = 100.0 * (2.0 * std::fabs(offset) * half + half * half) / (after * after);
          need(std::fabs(std::atof(m[2].str().c_str()) - part) <= 0.5 + wide, "an offset of another size",
               m[0]);
        });
    nothing_left(sentence);
  }
};

}  // namespace printed
