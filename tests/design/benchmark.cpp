// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Does the designed experiment decide? A closed loop on plants of the blind benchmark, whose causes are hidden from the design:
// record, diagnose, design, play the schedule on the plant, diagnose again. The same with other experiments in the place of the
// designed one, within the same limits.
//
//     design_benchmark [--cases N] [--seed S] [--contenders designed,random,chirp,fixed,fisher] [--violations N]
//
// A case counts where the first recording leaves more than one explanation. It is resolved where an explanation has 0.9 or more
// after one or two experiments: rightly where that is the hidden cause, of a cause outside of the catalogue where nothing but curves is named.

#include "../gap_benchmark/axis_draw.hpp"
#include "../gap_benchmark/bench_draw.hpp"

#include <thermopower/design/design.hpp>
#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
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
    plants::draw_unknown(
        setup,
        static_cast<plants::AxisUnknown>(random.integer(1, static_cast<int>(plants::axis_unknowns().size()))),
        random);
  } else {
    if (!effect.possible(setup.context)) return std::nullopt;
    effect.draw(random, setup.context, setup.plant);
    drawn.truth = effect.id;
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
    plants::draw_unknown(setup,
                         static_cast<plants::BenchUnknown>(
                             random.integer(1, static_cast<int>(plants::bench_unknowns().size()))),
                         random);
  } else {
    if (!effect.possible(setup.context)) return std::nullopt;
    effect.draw(random, setup.context, setup.plant);
    drawn.truth = effect.id;
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

/// What a diagnosis comes to: its likeliest explanation, where that is sure.
Answer answer_of(const Diagnosis& diagnosis, const HiddenCase& hidden) {
  if (diagnosis.ranking.empty()) return Answer::open;
  const auto& best = *std::max_element(
      diagnosis.ranking.begin(), diagnosis.ranking.end(),
      [](const RankedExplanation& a, const RankedExplanation& b) { return a.probability < b.probability; });
  const bool only_curves = std::all_of(best.effects.begin(), best.effects.end(),
                                       [](const std::string& id) { return id.rfind("unknown.", 0) == 0; });
  if (hidden.truth.empty() &&
      (diagnosis.verdict == Verdict::unexplained || (only_curves && best.probability >= named)))
    return Answer::right;
  if (best.probability < named || diagnosis.verdict == Verdict::unexplained ||
      diagnosis.verdict == Verdict::insufficient)
    return Answer::open;
  if (hidden.truth.empty()) return Answer::wrong;
  const auto is_it = [&](const std::string& id) {
    return id == hidden.truth ||
           std::find(hidden.contained_in.begin(), hidden.contained_in.end(), id) != hidden.contained_in.end();
  };
  return best.effects.size() == 1 && is_it(best.effects.front()) ? Answer::right : Answer::wrong;
}

/// Whether the hidden cause is among what a design says is left; of a cause outside of the catalogue, a curve.
bool holds_truth(const Design& design, const HiddenCase& hidden) {
  for (const ExplanationClass& one : design.classes)
    for (const std::vector<std::string>& ids : one.members)
      for (const std::string& id : ids) {
        const auto& richer = hidden.contained_in;
        if (id == hidden.truth || std::find(richer.begin(), richer.end(), id) != richer.end()) return true;
        if (hidden.truth.empty() && id.rfind("unknown.", 0) == 0) return true;
      }
  return false;
}

/// Whether the first recording leaves anything to decide.
bool leaves_open(const DiagnosedGap& gap) {
  if (gap.verdict == Verdict::insufficient || gap.verdict == Verdict::no_gap ||
      gap.verdict == Verdict::unexplained)
    return false;
  const auto open = still_open(gap, standard_catalogue());
  if (open.size() < 2) return false;
  return open.front().probability() < named || open[1].is_tied || open[1].probability() >= 0.02;
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

struct Tally {
  int cases = 0, right = 0, wrong = 0, open = 0;
  int one_class = 0, one_class_rightly = 0;  ///< of the open: what is left predicts alike in every experiment
  int cannot = 0,
      cannot_rightly = 0;  ///< of the open: no experiment decides; rightly: the truth is among what is left
  std::vector<double>
      duration_s;  ///< of the experiments until it was resolved rightly, in units of the longest one allowed
  double design_s = 0.0;  ///< spent by all designs
  int designs = 0;
  std::string sentence;  ///< of the last design
  Design last;
};

double median(std::vector<double> values) {
  if (values.empty()) return missing;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The next experiment of a contender; none where it says that there is none.
std::optional<Recording> next_of(const std::string& contender, int number, const DiagnosedGap& gap,
                                 const Limits& limits, unsigned seed, Tally& tally) {
  if (contender == "designed") {
    const auto begin = std::chrono::steady_clock::now();
    DesignOptions options;
    options.seed = seed;
    const Design next = design_experiment(gap, limits, options);
    tally.design_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++tally.designs;
    tally.sentence = next.sentence;
    tally.last = next;
    if (next.ending != Ending::schedule) return std::nullopt;
    return next.schedule;
  }
  const std::vector<Possible> explanations = still_open(gap, standard_catalogue());
  const Predictor predictor(gap, standard_catalogue(), limits);
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

}  // namespace

int main(int count, char** values) {
  int cases = 60, violations = 0;
  std::uint64_t seed = 1;
  std::string list = "designed,random,chirp,fixed,fisher";
  for (int i = 1; i + 1 < count; i += 2) {
    if (!std::strcmp(values[i], "--cases")) cases = std::atoi(values[i + 1]);
    else if (!std::strcmp(values[i], "--seed")) seed = std::strtoull(values[i + 1], nullptr, 10);
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
  int drawn = 0, played = 0, draws = 0, passed = 0;
  double most_passed = 0.0;
  for (std::uint64_t number = 0; played < cases; ++number) {
    plants::Random random(seed * 1000003u + number);
    const bool outside = random.chance(0.15), axis = random.chance(0.6);
    const double share = random.pick({0.15, 0.3, 1.0});
    const auto hidden = axis ? axis_case(outside, share, random) : bench_case(outside, share, random);
    if (!hidden) continue;
    ++drawn;
    Diagnosis first;
    try {
      first = diagnose(hidden->model, {hidden->first});
    } catch (const std::exception&) {
      continue;
    }
    const DiagnosedGap gap = gap_of(hidden->model, first);
    if (!leaves_open(gap)) continue;
    ++played;
    for (const std::string& contender : contenders) {
      Tally& tally = tallies[contender];
      ++tally.cases;
      std::vector<Recording> recordings{hidden->first};
      DiagnosedGap now = gap;
      Answer answer = Answer::open;
      double spent_s = 0.0;
      std::string steps;
      for (int i = 0; i < most_experiments && answer == Answer::open; ++i) {
        const auto schedule =
            next_of(contender, i, now, hidden->limits,
                    static_cast<unsigned>(seed + number * 10 + static_cast<std::uint64_t>(i)), tally);
        if (!schedule) {
          steps += " none: " + tally.sentence;
          break;
        }
        if (contender == "designed" && violations > 0) {
          Random draw(static_cast<unsigned>(number) + 7u);
          const Predictor predictor(now, standard_catalogue(), hidden->limits);
          for (const Possible& one : still_open(now, standard_catalogue()))
            for (int k = 0; k < violations; ++k) {
              const double use = use_of(predictor.free_run(*schedule, one.draw(draw)), hidden->limits).share;
              ++draws;
              passed += use > 1.0;
              most_passed = std::max(most_passed, use);
            }
        }
        spent_s += schedule->t_s[schedule->rows() - 1];
        recordings.push_back(
            hidden->play(*schedule, seed * 7919u + number * 10u + static_cast<std::uint64_t>(i)));
        try {
          const Diagnosis next = diagnose(hidden->model, recordings);
          answer = answer_of(next, *hidden);
          now = gap_of(hidden->model, next);
          const auto best =
              std::max_element(next.ranking.begin(), next.ranking.end(),
                               [](const auto& a, const auto& b) { return a.probability < b.probability; });
          if (best != next.ranking.end()) {
            char text[32];
            std::snprintf(text, sizeof text, "%.2f", best->probability);
            steps +=
                " [" + std::string(to_string(next.verdict)) + " " + name_of(best->effects) + " " + text + "]";
          }
        } catch (const std::exception& error) {
          steps += std::string(" refused: ") + error.what();
          break;
        }
      }
      if (answer == Answer::right) {
        ++tally.right;
        tally.duration_s.push_back(spent_s / hidden->limits.duration_s);
      } else if (answer == Answer::wrong) {
        ++tally.wrong;
      } else {
        ++tally.open;
        if (steps.find("none") != std::string::npos && contender == "designed") {
          const bool rightly = holds_truth(tally.last, *hidden);
          const bool is_class = tally.last.ending == Ending::enough;
          (is_class ? tally.one_class : tally.cannot) += 1;
          (is_class ? tally.one_class_rightly : tally.cannot_rightly) += rightly;
        }
      }
      std::printf("%d %s %s, truth %s, share %.2f: %s in %.2f of the longest;%s\n", played,
                  axis ? "axis" : "bench", contender.c_str(),
                  hidden->truth.empty() ? "outside" : hidden->truth.c_str(), share,
                  answer == Answer::right   ? "right"
                  : answer == Answer::wrong ? "wrong"
                                            : "open",
                  spent_s / hidden->limits.duration_s, steps.c_str());
      std::fflush(stdout);
    }
  }
  std::printf("\n%d of %d recordings leave something open\n", played, drawn);
  std::printf(
      "| experiment | cases | right | wrong | open | one class is left (rightly) | none decides (rightly) | median duration "
      "where right, share of the longest |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& contender : contenders) {
    const Tally& t = tallies[contender];
    std::printf("| %s | %d | %d | %d | %d | %d (%d) | %d (%d) | %.2f |\n", contender.c_str(), t.cases,
                t.right, t.wrong, t.open, t.one_class, t.one_class_rightly, t.cannot, t.cannot_rightly,
                median(t.duration_s));
  }
  for (const std::string& contender : contenders) {
    const Tally& t = tallies[contender];
    if (t.designs > 0) std::printf("%d designs, %.2f s each\n", t.designs, t.design_s / t.designs);
  }
  if (draws > 0)
    std::printf("%d plants drawn from what is possible: %d passed a limit, at most %.2f of it was used\n",
                draws, passed, most_passed);
  return 0;
}
