// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Does the designed experiment decide? A closed loop on plants of the blind benchmark, whose causes are hidden from the design:
// record, diagnose, design, play the schedule on the plant, diagnose again. The same with other experiments in the place of the
// designed one, within the same limits.
//
//     design_benchmark [--cases N] [--seed S] [--draws 3,17] [--contenders designed,random,chirp,fixed,fisher] [--violations N] [--alike 1] [--svg FILE]
//
// --alike 1 plays experiments also where one class is left: do others tell its members apart?
//
// A case counts where the report of the first recording names no cause with 0.9. Explanations that the first design finds alike within the
// limits are one class. A case is resolved where a class has 0.9: rightly where the hidden cause is in it, of a cause outside of the
// catalogue where a curve is, or where "none of these" is the answer.

#include "../gap_benchmark/axis_draw.hpp"
#include "../gap_benchmark/bench_draw.hpp"

#include "small_multiples.hpp"

#include <thermopower/design/design.hpp>
#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace plants = gap_benchmark;
using namespace thermopower::gap;
using namespace thermopower::design;

constexpr double named = 0.9;  // probability from which on an explanation is an answer
constexpr int most_experiments = 2;

Recording recording_of(const plants::Recording& log, const std::string& name) {
  Recording recording;
  recording.name = name;
  for (const plants::Column& column : log.columns) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(column.values.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = column.values[static_cast<std::size_t>(i)];
    if (column.name == "t_s") recording.t_s = values;
    else recording.columns.push_back({column.name, values});
  }
  return recording;
}

/// A plant with a hidden cause, and what may be done with it.
struct HiddenCase {
  std::string truth;                      ///< id; empty: outside of the catalogue
  std::string label;                      ///< the same in words
  std::vector<std::string> contained_in;  ///< richer kinds of the same cause
  Model model;
  Limits limits;
  Recording first;
  std::function<Recording(const Recording& schedule, std::uint64_t seed)> play;
};

std::vector<double> column_of(const Recording& schedule, const char* name) {
  const Eigen::VectorXd& values = schedule.column(name);
  return {values.begin(), values.end()};
}

template <class Effects>
std::vector<std::string> richer_kinds(const Effects& effects, const std::string& id) {
  std::vector<std::string> list;
  for (const auto& one : effects)
    if (std::find(one.contains.begin(), one.contains.end(), id) != one.contains.end()) list.push_back(one.id);
  return list;
}

/// @param share  of the benchmark's recording that is recorded at first: weak data leave more open
std::optional<HiddenCase> axis_case(bool outside, double share, plants::Random& random) {
  const auto& effects = plants::axis_effects();
  const auto& effect =
      effects[static_cast<std::size_t>(random.integer(0, static_cast<int>(effects.size()) - 1))];
  HiddenCase drawn;
  plants::AxisSetup setup =
      plants::draw_axis(outside ? std::vector<std::string>{} : std::vector<std::string>{effect.id}, random);
  setup.jitter = setup.missing_cells = false;
  setup.decoys.clear();
  setup.context.dt_s = std::max(setup.context.dt_s, 0.005);
  plants::AxisSession session{plants::any_motion(random), share * 30.0, random.uniform(0.0, 6.28), 1,
                              random.bits()};
  plants::measure_session(setup, session, plants::Random(random.bits()));
  setup.plant = setup.context.plant;
  if (outside) {
    const int which = random.integer(1, static_cast<int>(plants::axis_unknowns().size()));
    plants::draw_unknown(setup, static_cast<plants::AxisUnknown>(which), random);
    drawn.label = plants::axis_unknowns()[static_cast<std::size_t>(which) - 1].second;
  } else {
    if (!effect.possible(setup.context)) return std::nullopt;
    effect.draw(random, setup.context, setup.plant);
    drawn.truth = drawn.label = effect.id;
    drawn.contained_in = richer_kinds(effects, effect.id);
  }
  const plants::AxisParameters& m = setup.context.model;
  drawn.model.name = "axis";
  drawn.model.axis = RigidAxisModel{m[plants::inertia], m[plants::viscous], m[plants::torque_constant]};
  const plants::AxisRecording first = plants::record(setup, session, plants::Random(random.bits()));
  for (const double angle : first.truth.angle_deg)
    if (!(std::abs(angle) < 4000.0)) return std::nullopt;
  drawn.first = recording_of(first.log, "first");
  Limits& limits = drawn.limits;
  limits.duration_s = 20.0;
  limits.row_s = std::max(setup.context.dt_s, 0.01);
  limits.vary = {{"drive_A", -setup.top_A, setup.top_A}};
  if (setup.context.has_motor) limits.hold = {{"motor_C", setup.first_C}};
  limits.angle_deg = {-720.0, 720.0};
  limits.rate_dps = {-900.0, 900.0};
  drawn.play = [setup, session, row_s = limits.row_s](const Recording& schedule, std::uint64_t seed) {
    plants::AxisSetup played = setup;
    plants::AxisSession again = session;
    played.context.dt_s = row_s;
    again.commands_A = column_of(schedule, "drive_A");
    again.length_s = row_s * (static_cast<double>(schedule.rows()) - 0.5);
    return recording_of(plants::record(played, again, plants::Random(seed)).log,
                        "played" + std::to_string(seed % 1000));
  };
  return drawn;
}

std::optional<HiddenCase> bench_case(bool outside, double share, plants::Random& random) {
  const auto& effects = plants::bench_effects();
  const auto& effect =
      effects[static_cast<std::size_t>(random.integer(0, static_cast<int>(effects.size()) - 1))];
  HiddenCase drawn;
  plants::BenchSetup setup = plants::draw_bench(
      outside ? std::vector<std::string>{} : std::vector<std::string>{effect.id}, false, random);
  setup.jitter = setup.gaps = setup.missing_cells = setup.warm_start = false;
  setup.decoys.clear();
  if (setup.context.thesis() || setup.context.current_is_input) return std::nullopt;
  if (outside) {
    const int which = random.integer(1, static_cast<int>(plants::bench_unknowns().size()));
    plants::draw_unknown(setup, static_cast<plants::BenchUnknown>(which), random);
    drawn.label = plants::bench_unknowns()[static_cast<std::size_t>(which) - 1].second;
  } else {
    if (!effect.possible(setup.context)) return std::nullopt;
    effect.draw(random, setup.context, setup.plant);
    drawn.truth = drawn.label = effect.id;
    drawn.contained_in = richer_kinds(effects, effect.id);
  }
  plants::BenchSession session{plants::PowerProfile::any(random),
                               share * setup.context.length_s,
                               22.0,
                               0.0,
                               random.uniform(0.0, 6.28),
                               1,
                               random.bits()};
  const plants::BenchParameters& m = setup.context.model;
  drawn.model.name = "bench";
  drawn.model.supply = SupplyModel{setup.context.nominal_V};
  drawn.model.current =
      OhmicCurrentModel{m[plants::resistance_ohm], m[plants::tempco_per_K], m[plants::reference_C]};
  drawn.model.thermal = LumpedThermalModel{m[plants::heat_capacity], m[plants::conductance]};
  drawn.first = recording_of(plants::record(setup, session, plants::Random(random.bits())).log, "first");
  Limits& limits = drawn.limits;
  limits.duration_s = 6.0 * setup.tau_s;
  limits.row_s = setup.dt_s;
  limits.vary = {{"power_param", 0.0, 255.0}};
  limits.hold = {{"ambient_C", 22.0}};
  if (setup.context.has_supply) limits.hold.push_back({"supply_V", setup.context.nominal_V});
  if (setup.context.has_airspeed) limits.hold.push_back({"airspeed_mps", 0.0});
  if (setup.context.has_neighbour) limits.hold.push_back({"neighbour_C", 30.0});
  limits.start = {{"motor_C", 24.0}};
  limits.temperature_C.high = setup.limit_C + 15.0;
  if (limits.validate()) return std::nullopt;
  drawn.play = [setup, session](const Recording& schedule, std::uint64_t seed) {
    plants::BenchSession again = session;
    again.commands = column_of(schedule, "power_param");
    again.length_s = setup.dt_s * (static_cast<double>(schedule.rows()) - 0.5);
    return recording_of(plants::record(setup, again, plants::Random(seed)).log,
                        "played" + std::to_string(seed % 1000));
  };
  return drawn;
}

enum class Answer { open, right, wrong };

using Ids = std::vector<std::string>;

/// Explanations of which the design says that no experiment within the limits tells them apart.
using Alike = std::vector<std::vector<Ids>>;

bool is_curve(const std::string& id) { return id.rfind("unknown.", 0) == 0; }

Alike alike_of(const Design& design) {
  Alike alike;
  for (const ExplanationClass& one : design.classes) alike.push_back(one.members);
  return alike;
}

/// Whether an explanation is the hidden cause or a richer kind of it; of a cause outside of the catalogue, of curves alone.
bool is_truth(const Ids& ids, const HiddenCase& hidden) {
  if (hidden.truth.empty()) return !ids.empty() && std::all_of(ids.begin(), ids.end(), is_curve);
  return ids.size() == 1 &&
         (ids.front() == hidden.truth || std::find(hidden.contained_in.begin(), hidden.contained_in.end(),
                                                   ids.front()) != hidden.contained_in.end());
}

/// What a report comes to, apart from `unexplained`: its likeliest explanation and those that are alike, where they are sure together.
Answer answer_of(const DiagnosedGap& gap, const Alike& alike, const HiddenCase& hidden) {
  if (gap.ranking.empty() || gap.verdict == Verdict::insufficient) return Answer::open;
  const auto best = std::max_element(
      gap.ranking.begin(), gap.ranking.end(),
      [](const auto& one, const auto& other) { return one.probability < other.probability; });
  const auto holds = [](const std::vector<Ids>& group, const Ids& ids) {
    return std::find(group.begin(), group.end(), ids) != group.end();
  };
  std::vector<Ids> group{best->effects};
  for (const std::vector<Ids>& one : alike)
    if (holds(one, best->effects)) group = one;
  double together = 0.0;
  for (const RankedExplanation& one : gap.ranking)
    if (holds(group, one.effects)) together += one.probability;
  // A single sure cause is ambiguous where refitted constants do without it.
  if (together < named || (gap.verdict == Verdict::ambiguous && group.size() == 1)) return Answer::open;
  // Where no name is right, the likeliest has to be a curve.
  const auto is_it = [&](const Ids& ids) { return is_truth(ids, hidden); };
  const bool right =
      hidden.truth.empty() ? is_it(best->effects) : std::any_of(group.begin(), group.end(), is_it);
  return right ? Answer::right : Answer::wrong;
}

/// Probability of the hidden cause and of what is alike.
double probability_of_truth(const DiagnosedGap& gap, const Alike& alike, const HiddenCase& hidden) {
  double sum = 0.0;
  for (const RankedExplanation& one : gap.ranking) {
    std::vector<Ids> group{one.effects};
    for (const std::vector<Ids>& each : alike)
      if (std::find(each.begin(), each.end(), one.effects) != each.end()) group = each;
    if (std::any_of(group.begin(), group.end(), [&](const Ids& ids) { return is_truth(ids, hidden); }))
      sum += one.probability;
  }
  return sum;
}

/// Whether the first recording leaves anything to decide: a report that names no cause with 0.9.
bool leaves_open(const DiagnosedGap& gap) {
  if (gap.verdict != Verdict::ambiguous && gap.verdict != Verdict::partial) return false;
  const auto open = still_open(gap, standard_catalogue());
  return open.size() > 1 && open.front().probability() < named;
}

/// An experiment of a fixed kind as long as asked, as large as the limits allow.
std::optional<Recording> fixed_kind(Shape shape, bool is_chirp, const Limits& limits, Search& search) {
  const double length_s = limits.duration_s;
  Piece piece;
  piece.shape = shape;
  piece.duration_s = length_s;
  piece.size = 0.5;
  piece.level = limits.vary.front().from < 0.0 ? 0.0 : 0.5;
  piece.period_s = length_s / 8.0;
  piece.last_period_s = is_chirp ? std::max(length_s / 100.0, 8.0 * limits.row_s) : piece.period_s;
  auto safe = search.made_safe({{{{piece}, 0.0}}});
  if (!safe) return std::nullopt;
  return safe->schedule;
}

/// Probability after so many seconds of experiments, in units of the longest one; it holds until the next.
using Truth = std::vector<std::pair<double, double>>;

struct Tally {
  int right = 0, wrong = 0, open = 0;
  /// Of the open: the design says that no experiment decides; the truth is in its list.
  int cannot = 0, cannot_rightly = 0;
  /// Until it was resolved rightly, in units of the longest experiment; else infinite.
  std::vector<double> duration_s;
  std::vector<Truth> truths;  ///< of the hidden cause, in each case with one
};

struct Spent {
  double seconds = 0.0;
  int designs = 0;
};

double median(std::vector<double> values) {
  if (values.empty()) return missing;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Design designed(const DiagnosedGap& gap, const Limits& limits, unsigned seed, Spent& spent) {
  const auto begin = std::chrono::steady_clock::now();
  DesignOptions options;
  options.seed = seed;
  Design next = design_experiment(gap, limits, options);
  spent.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ++spent.designs;
  return next;
}

/// The next experiment of a contender that is not designed; none where it finds none.
std::optional<Recording> next_of(const std::string& contender, int number, const DiagnosedGap& gap,
                                 const Limits& limits, unsigned seed) {
  const Predictor predictor(gap, standard_catalogue(), limits);
  std::vector<Possible> explanations = still_open(gap, standard_catalogue());
  explanations.erase(std::remove_if(explanations.begin(), explanations.end(),
                                    [&](const Possible& one) { return !predictor.has_inputs_of(one); }),
                     explanations.end());
  if (explanations.empty()) return std::nullopt;
  DesignOptions options;
  options.seed = seed;
  Search search(predictor, explanations, limits, options);
  Random random(seed);
  const Library library(limits);
  if (contender == "chirp") return fixed_kind(Shape::sine, true, limits, search);
  if (contender == "fixed") {
    constexpr Shape shapes[] = {Shape::square, Shape::triangle, Shape::sine, Shape::sine};
    return fixed_kind(shapes[number % 4], number % 4 == 3, limits, search);
  }
  if (contender == "random") {
    for (int i = 0; i < 20; ++i) {
      Experiment one = library.draw(random);
      one.stretch(limits.duration_s / one.duration_s());
      if (auto safe = search.made_safe(one)) return safe->schedule;
    }
    return std::nullopt;
  }
  // Largest information of the likeliest explanation's parameters (D-optimality).
  double best = -1.0;
  std::optional<Tried> most;
  search.screen(1e6);
  for (const Tried& one : search.tried()) {
    const Motion along = predictor.free_run(one.schedule, explanations.front().fit());
    const Prediction prediction = predictor.predictions(one.schedule, along, {explanations.front()}).front();
    Eigen::MatrixXd information = prediction.open.transpose() * prediction.open;
    information.diagonal().array() += 1.0;
    const double size = information.rows() > 0 ? information.ldlt().vectorD().array().log().sum() : 0.0;
    if (size > best) best = size, most = one;
  }
  if (most) most = search.made_safe(most->experiment);
  if (!most) return std::nullopt;
  return most->schedule;
}

/// Draws the mean probability of the hidden cause against seconds, for each contender.
void draw_truths(const std::string& path, const std::vector<std::string>& contenders,
                 const std::map<std::string, Tally>& tallies) {
  const char* const colours[] = {"#0b7285", "#c92a2a", "#868e96", "#e67700", "#5f3dc4"};
  figures::Panel panel, resolved;
  resolved.title = "resolved rightly";
  resolved.x_label = "experiments, in units of the longest one";
  resolved.y_label = "share of the cases";
  resolved.y_to = 1.0;
  panel.title = "hidden cause of the catalogue";
  panel.x_label = "experiments, in units of the longest one";
  panel.y_label = "mean probability";
  panel.y_to = 1.0;
  for (std::size_t k = 0; k < contenders.size(); ++k) {
    figures::Series series{contenders[k], colours[k % 5], figures::Mark::line, {}, {}};
    const std::vector<Truth>& truths = tallies.at(contenders[k]).truths;
    for (double t = 0.0; t <= 2.0; t += 0.01) {
      double sum = 0.0;
      for (const Truth& one : truths)
        sum +=
            std::find_if(one.rbegin(), one.rend(), [&](const auto& step) { return step.first <= t; })->second;
      series.x.push_back(t);
      series.y.push_back(sum / static_cast<double>(truths.size()));
    }
    panel.series.push_back(series);
    const std::vector<double>& ends = tallies.at(contenders[k]).duration_s;
    for (std::size_t i = 0; i < series.x.size(); ++i)
      series.y[i] = static_cast<double>(std::count_if(ends.begin(), ends.end(),
                                                      [&](double end) { return end <= series.x[i]; })) /
                    static_cast<double>(ends.size());
    resolved.series.push_back(std::move(series));
  }
  figures::write_small_multiples(path, "How sure the hidden cause becomes", {panel, resolved}, 2);
}

std::vector<std::uint64_t> numbers_of(const char* list) {
  std::vector<std::uint64_t> numbers;
  std::stringstream text(list);
  for (std::string one; std::getline(text, one, ',');)
    numbers.push_back(std::strtoull(one.c_str(), nullptr, 10));
  return numbers;
}

}  // namespace

int main(int count, char** values) {
  int cases = 60, violations = 0, played = 0;
  bool also_alike = false;
  std::uint64_t seed = 1;
  std::vector<std::uint64_t> only;
  std::string svg, list = "designed,random,chirp,fixed,fisher";
  for (int i = 1; i + 1 < count; i += 2) {
    if (!std::strcmp(values[i], "--cases")) cases = std::atoi(values[i + 1]);
    else if (!std::strcmp(values[i], "--seed")) seed = std::strtoull(values[i + 1], nullptr, 10);
    else if (!std::strcmp(values[i], "--draws")) only = numbers_of(values[i + 1]);
    else if (!std::strcmp(values[i], "--svg")) svg = values[i + 1];
    else if (!std::strcmp(values[i], "--alike")) also_alike = std::atoi(values[i + 1]) != 0;
    else if (!std::strcmp(values[i], "--contenders")) list = values[i + 1];
    else if (!std::strcmp(values[i], "--violations")) violations = std::atoi(values[i + 1]);
    else {
      std::fprintf(stderr, "design_benchmark: unknown option %s\n", values[i]);
      return 2;
    }
  }
  std::vector<std::string> contenders;
  std::stringstream names(list);
  for (std::string one; std::getline(names, one, ',');) contenders.push_back(one);
  std::map<std::string, Tally> tallies;
  Spent spent;
  int drawn = 0, one_class = 0, one_class_rightly = 0, draws = 0, passed = 0;
  double most_passed = 0.0;
  for (std::uint64_t i = 0; only.empty() ? played < cases : i < only.size(); ++i) {
    const std::uint64_t number = only.empty() ? i : only[i];
    plants::Random random(seed * 1000003u + number);
    const bool outside = random.chance(0.15), axis = random.chance(0.6);
    const double share = random.pick({0.05, 0.15, 0.3, 1.0});
    const auto hidden = axis ? axis_case(outside, share, random) : bench_case(outside, share, random);
    if (!hidden) continue;
    ++drawn;
    DiagnosedGap gap;
    try {
      gap = gap_of(hidden->model, diagnose(hidden->model, {hidden->first}));
    } catch (const std::exception&) {
      continue;
    }
    if (!leaves_open(gap)) continue;
    const auto seed_of = [&](int k) {
      return static_cast<unsigned>(seed + number * 10 + static_cast<std::uint64_t>(k));
    };
    Design first;
    try {
      first = designed(gap, hidden->limits, seed_of(0), spent);
    } catch (const std::exception&) {
      continue;
    }
    const Alike alike = alike_of(first);
    std::printf("%d draw %d %s truth %s, share %.2f, %s:", played + 1, static_cast<int>(number),
                axis ? "axis" : "bench", hidden->label.c_str(), share, to_string(gap.verdict));
    ++played;
    Answer at_once = answer_of(gap, alike, *hidden);
    if (at_once != Answer::open && first.ending == Ending::none_of_these)
      at_once = hidden->truth.empty() ? Answer::right : Answer::wrong;
    if (at_once != Answer::open && first.ending != Ending::schedule) {
      ++one_class;
      one_class_rightly += at_once == Answer::right;
      std::printf(" one class is left, %s: %s\n", at_once == Answer::right ? "rightly" : "wrongly",
                  first.sentence.c_str());
      if (!also_alike) continue;
    }
    for (const std::string& contender : contenders) {
      Tally& tally = tallies[contender];
      std::vector<Recording> recordings{hidden->first};
      DiagnosedGap now = gap;
      Design next = first;
      Answer answer = Answer::open;
      double spent_s = 0.0;
      std::string steps;
      Truth truth{{0.0, probability_of_truth(gap, alike, *hidden)}};
      for (int turn = 0; answer == Answer::open; ++turn) {
        std::optional<Recording> schedule;
        try {
          if (contender == "designed") {
            // After the last experiment the design has the last word on what remains open.
            if (turn > 0) next = designed(now, hidden->limits, seed_of(turn), spent);
            if (next.ending == Ending::schedule) schedule = next.schedule;
          } else if (turn < most_experiments) {
            schedule = next_of(contender, turn, now, hidden->limits, seed_of(turn));
          }
        } catch (const std::exception& error) {
          steps += std::string(" refused: ") + error.what();
          break;
        }
        if (contender == "designed" && next.ending != Ending::schedule) {
          steps += " " + next.sentence;
          if (next.ending == Ending::none_of_these)
            answer = hidden->truth.empty() ? Answer::right : Answer::wrong;
          if (next.ending == Ending::enough) answer = answer_of(now, alike_of(next), *hidden);
          if (next.ending == Ending::cannot_decide || next.ending == Ending::nothing_possible) {
            ++tally.cannot;
            const Alike left = alike_of(next);
            tally.cannot_rightly += std::any_of(left.begin(), left.end(), [&](const std::vector<Ids>& group) {
              return std::any_of(group.begin(), group.end(),
                                 [&](const Ids& ids) { return is_truth(ids, *hidden); });
            });
          }
        }
        if (!schedule || turn == most_experiments) break;
        if (contender == "designed" && violations > 0) {
          Random draw(static_cast<unsigned>(number) + 7u);
          const Predictor predictor(now, standard_catalogue(), hidden->limits);
          for (const Possible& one : still_open(now, standard_catalogue()))
            for (int k = 0; predictor.has_inputs_of(one) && k < violations; ++k) {
              const double use = use_of(predictor.free_run(*schedule, one.draw(draw)), hidden->limits).share;
              ++draws;
              passed += use > 1.0;
              most_passed = std::max(most_passed, use);
            }
        }
        spent_s += schedule->t_s[schedule->rows() - 1];
        recordings.push_back(
            hidden->play(*schedule, seed * 7919u + number * 10u + static_cast<std::uint64_t>(turn)));
        try {
          now = gap_of(hidden->model, diagnose(hidden->model, recordings));
        } catch (const std::exception& error) {
          steps += std::string(" refused: ") + error.what();
          break;
        }
        truth.emplace_back(spent_s / hidden->limits.duration_s, probability_of_truth(now, alike, *hidden));
        // What is unexplained, or leaves much, is open until the design has said what to make of it.
        if (now.verdict != Verdict::unexplained && now.times_noise() <= DesignOptions().much_left)
          answer = answer_of(now, alike, *hidden);
        else if (contender != "designed" && hidden->truth.empty()) answer = Answer::right;
        const auto best =
            std::max_element(now.ranking.begin(), now.ranking.end(),
                             [](const auto& a, const auto& b) { return a.probability < b.probability; });
        if (best == now.ranking.end()) continue;
        char text[64];
        std::snprintf(text, sizeof text, " %.2f, leaves %.1f, in %.2f of the longest]", best->probability,
                      now.times_noise(), spent_s / hidden->limits.duration_s);
        steps += " [" + std::string(to_string(now.verdict)) + " " + name_of(best->effects) + text;
      }
      if (!hidden->truth.empty()) tally.truths.push_back(truth);
      tally.right += answer == Answer::right;
      tally.wrong += answer == Answer::wrong;
      tally.open += answer == Answer::open;
      tally.duration_s.push_back(answer == Answer::right ? spent_s / hidden->limits.duration_s
                                                         : std::numeric_limits<double>::infinity());
      std::printf(" %s %s;%s\n", contender.c_str(),
                  answer == Answer::right   ? "right"
                  : answer == Answer::wrong ? "wrong"
                                            : "open",
                  steps.c_str());
      std::fflush(stdout);
    }
  }
  std::printf("\n%d of %d recordings leave something open; %d of them need no experiment, %d rightly\n",
              played, drawn, one_class, one_class_rightly);
  std::printf(
      "| experiment | right | wrong | open | of them no experiment decides (rightly) | median duration, share of the longest |\n"
      "|---|---|---|---|---|---|\n");
  for (const std::string& contender : contenders) {
    const Tally& t = tallies[contender];
    std::printf("| %s | %d | %d | %d | %d (%d) | %.2f |\n", contender.c_str(), t.right, t.wrong, t.open,
                t.cannot, t.cannot_rightly, median(t.duration_s));
  }
  if (!svg.empty()) draw_truths(svg, contenders, tallies);
  if (spent.designs > 0)
    std::printf("%d designs, %.2f s each\n", spent.designs, spent.seconds / spent.designs);
  if (draws > 0)
    std::printf("%d plants drawn from what is possible: %d passed a limit, at most %.2f of it was used\n",
                draws, passed, most_passed);
  return 0;
}
