// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// thermopower-gap: where a simulated actuator and the real one part, which effect is missing, and how far the
// gap shrinks with it.

#include "fleet.hpp"
#include "html_text.hpp"
#include "keep_memory.hpp"
#include "nearest_name.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/gap/data/splitting.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/standard_catalogue.hpp>
#include <thermopower/version.hpp>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

enum ExitStatus : int { made = 0, failed = 1, wrong_usage = 2, invalid_input = 3, too_little_data = 4 };

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Arguments {
  std::string model, report, html, predictions, augmented, header, mjcf, urdf;
  /// Every output that may be asked for.
  std::vector<const std::string*> outputs() const {
    return {&report, &html, &predictions, &augmented, &header, &mjcf, &urdf};
  }
  std::vector<std::string> recordings, held_out, without, columns, maps, starts;
  bool as_recorded = false;
  bool of_fleet = false;  // one log of it: nothing is said, and its paths are the fleet's own
  double horizon_s = 0.5;
  double tolerance = 0.05;
  unsigned threads = 0;
  unsigned seed = 1;
};

/// Tells a person at a terminal what takes so long; silent for the first second, and when nobody watches.
class Progress {
public:
  Progress() {
    if (isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { run(); });
  }
  ~Progress() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void stage(const char* name) { stage_ = name; }

private:
  void run() {
    const auto begin = std::chrono::steady_clock::now();
    bool shown = false;
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::milliseconds(250), [this] { return done_; })) {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (seconds < 1.0) continue;
      std::fprintf(stderr, "\r\033[K%s ... %.0f s", stage_.load(), seconds);
      shown = true;
    }
    if (shown) std::fprintf(stderr, "\r\033[K");
  }

  std::atomic<const char*> stage_{"reading"};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

// Columns that a plant of one's own reads by names of its own.
std::vector<std::string> own_columns(const gap::Model& model) {
  std::vector<std::string> names;
  if (!model.own) return names;
  const auto& info = *model.own->equations->info();
  for (const auto& one : info.inputs) names.push_back(one.name);
  for (const auto& one : info.signals) names.push_back(one.name);
  return names;
}

// What stands on the command line goes before what a mapping file says of the same name.
std::vector<io::ColumnChoice> column_choices(const Arguments& arguments, const gap::Model& model) {
  std::vector<io::ColumnChoice> choices;
  const std::vector<std::string> own = own_columns(model);
  const auto find = [&](const std::string& name) {
    return std::find_if(choices.begin(), choices.end(),
                        [&](const io::ColumnChoice& one) { return one.name == name; });
  };
  for (const auto& path : arguments.maps)
    for (const auto& choice : io::read_column_map(path)) {
      if (find(choice.name) != choices.end())
        throw io::InputError(path + ": '" + choice.name + "' is in another mapping file, too");
      if (const std::string wrong = io::unknown_name(choice, own); !wrong.empty())
        throw io::InputError(path + ": " + wrong);
      choices.push_back(choice);
    }
  std::vector<std::string> given;
  try {
    for (const auto& text : arguments.columns) {
      const io::ColumnChoice choice = io::parse_column_choice(text);
      if (std::find(given.begin(), given.end(), choice.name) != given.end())
        throw UsageError("--column " + choice.name + " is given twice");
      if (const std::string wrong = io::unknown_name(choice, own); !wrong.empty())
        throw UsageError("--column " + text + ": " + wrong);
      given.push_back(choice.name);
      if (const auto known = find(choice.name); known != choices.end()) *known = choice;
      else choices.push_back(choice);
    }
  } catch (const io::InputError& error) {
    throw UsageError(error.what());
  }
  return choices;
}

// A choice of a fleet, before the models are known.
void expect_choice(const std::string& text) {
  try {
    io::parse_column_choice(text);
  } catch (const io::InputError& error) {
    throw UsageError(error.what());
  }
}

std::vector<gap::Recording> read_all(const std::vector<std::string>& paths,
                                     const std::vector<io::ColumnChoice>& choices,
                                     std::vector<gap::Finding>& findings) {
  std::vector<gap::Recording> list;
  for (const auto& path : paths) {
    io::RecordingFile file = io::read_recording(path, choices);
    list.push_back(std::move(file.recording));
    findings.insert(findings.end(), file.findings.begin(), file.findings.end());
  }
  return list;
}

// A path without detours: absolute, links followed as far as it exists.
std::filesystem::path plain_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(path, error);
  const std::filesystem::path plain = std::filesystem::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : plain;
}

// Two outputs in one file, or an output over an input, would lose one of them.
void refuse_overlaps(const Arguments& arguments) {
  std::vector<std::string> taken = arguments.recordings;
  taken.insert(taken.end(), arguments.held_out.begin(), arguments.held_out.end());
  taken.push_back(arguments.model);
  for (const auto* output : arguments.outputs()) {
    if (output->empty()) continue;
    std::error_code error;
    const bool special =
        std::filesystem::exists(*output, error) && !std::filesystem::is_regular_file(*output, error);
    for (const auto& other : taken) {
      // Spelt differently, or linked, it is one file all the same, whether it exists yet or not.
      const bool same =
          plain_path(*output) == plain_path(other) || std::filesystem::equivalent(*output, other, error);
      if (!special && same) {
        throw UsageError("'" + *output +
                         "' is named twice; an output must not be an input or another output");
      }
    }
    taken.push_back(*output);
  }
}

// The catalogue's list and the engine's `without` are two things; a misspelt id would silently remove
// nothing.
void check_ids(const std::vector<std::string>& ids, const gap::Catalogue& catalogue) {
  for (const auto& id : ids) {
    if (id.rfind("calibration.", 0) == 0 || catalogue.find(id) != nullptr) continue;
    throw UsageError("--without: there is no effect '" + id +
                     "'; 'thermopower-gap effects --model' lists them");
  }
}

// What a model is in other words; what cannot be said there is said on the screen, too.
void write_exports(const Arguments& arguments, const gap::Model& model, const std::string& origin,
                   const gap::Catalogue& catalogue, io::OutputFiles& outputs) {
  const auto put = [&outputs](const std::string& path, const std::string& text,
                              const std::vector<std::string>& left_out) {
    for (const std::string& one : left_out)
      std::fprintf(stderr, "%s: left out: %s\n", path.c_str(), one.c_str());
    outputs.put(path, text);
  };
  if (!arguments.header.empty()) {
    const io::MotorModelHeader header = io::motor_model_header(model, origin, catalogue);
    put(arguments.header, header.text, header.left_out);
  }
  if (!arguments.mjcf.empty()) {
    const io::SimulatorFile file = io::mjcf(model, origin, catalogue);
    put(arguments.mjcf, file.text, file.left_out);
  }
  if (!arguments.urdf.empty()) {
    const io::SimulatorFile file = io::urdf(model, origin, catalogue);
    put(arguments.urdf, file.text, file.left_out);
  }
}

// Found out before a computation, not after it.
gap::Model read_model(const Arguments& arguments, const gap::Catalogue& catalogue) {
  gap::Model model = io::read_model(arguments.model, catalogue);
  if (!model.axis && !(arguments.mjcf.empty() && arguments.urdf.empty()))
    throw io::InputError(arguments.model + ": /axis is missing; MJCF and URDF describe nothing else");
  return model;
}

int export_model(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  if (arguments.header.empty() && arguments.mjcf.empty() && arguments.urdf.empty())
    throw UsageError("export: expected at least one of --mjcf, --urdf and --header");
  io::OutputFiles outputs;
  for (const auto* path : arguments.outputs())
    if (!path->empty()) outputs.expect(*path);
  const gap::Model model = read_model(arguments, catalogue);
  write_exports(arguments, model, "from " + plain_path(arguments.model).filename().string(), catalogue,
                outputs);
  outputs.commit();
  return made;
}

int diagnose(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  if (!arguments.of_fleet) refuse_overlaps(arguments);
  io::OutputFiles outputs;
  for (const auto* path : arguments.outputs()) {
    if (!path->empty() && !arguments.of_fleet) outputs.expect(*path);
  }
  gap::Diagnosis diagnosis;
  gap::Model model;
  {
    Progress progress;
    model = read_model(arguments, catalogue);
    const std::vector<io::ColumnChoice> choices = column_choices(arguments, model);
    check_ids(arguments.without, gap::catalogue_of(model, catalogue));
    std::vector<gap::Finding> findings;
    std::vector<gap::Recording> recordings = read_all(arguments.recordings, choices, findings);
    std::vector<gap::Recording> held_out = read_all(arguments.held_out, choices, findings);
    gap::Options options;
    options.horizon_s = arguments.horizon_s;
    options.tolerance = arguments.tolerance;
    options.without = arguments.without;
    options.threads =
        arguments.threads != 0 ? arguments.threads : std::max(1u, std::thread::hardware_concurrency());
    options.seed = arguments.seed;
    options.as_recorded = arguments.as_recorded;
    if (held_out.empty()) {
      for (auto& recording : recordings) {
        auto [first, last] = gap::split(recording, options.held_out_fraction);
        recording = std::move(first);
        held_out.push_back(std::move(last));
      }
    }
    progress.stage("diagnosing");
    diagnosis = gap::diagnose(model, recordings, held_out, options, catalogue);
    diagnosis.findings.insert(diagnosis.findings.end(), findings.begin(), findings.end());
    progress.stage("writing");
    if (!arguments.report.empty()) outputs.put(arguments.report, io::report_json(diagnosis));
    if (!arguments.html.empty())
      outputs.put(arguments.html, io::report_html(diagnosis, model.name,
                                                  gap::catalogue_of(model, catalogue).list(), held_out));
    if (!arguments.predictions.empty()) {
      outputs.put(arguments.predictions,
                  io::predictions_csv(model, diagnosis, held_out, arguments.horizon_s, catalogue));
    }
    if (!arguments.augmented.empty()) outputs.put(arguments.augmented, io::to_json(diagnosis.augmented));
    write_exports(arguments, diagnosis.augmented, io::one_sentence(diagnosis), catalogue, outputs);
    outputs.commit();
  }
  if (!arguments.of_fleet) std::fputs(io::summary(diagnosis).c_str(), stdout);
  return diagnosis.verdict == gap::Verdict::insufficient ? too_little_data : made;
}

int check(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  io::OutputFiles outputs;
  if (!arguments.report.empty()) outputs.expect(arguments.report);
  gap::DataReport report;
  {
    Progress progress;
    const gap::Model model = io::read_model(arguments.model, catalogue);
    const std::vector<io::ColumnChoice> choices = column_choices(arguments, model);
    std::vector<gap::Finding> findings;
    const std::vector<gap::Recording> recordings = read_all(arguments.recordings, choices, findings);
    const std::vector<gap::Recording> held_out = read_all(arguments.held_out, choices, findings);
    gap::Options options;
    options.horizon_s = arguments.horizon_s;
    options.as_recorded = arguments.as_recorded;
    progress.stage("checking");
    report = gap::check_data(model, recordings, held_out, options, catalogue);
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
    if (!arguments.report.empty()) outputs.put(arguments.report, io::check_json(report));
    outputs.commit();
  }
  std::fputs(io::check_text(report).c_str(), stdout);
  return gap::deciding(report.findings) != nullptr || !report.too_little.empty() ? too_little_data : made;
}

// A number as recordings have it: decimal and finite, or nothing.
std::optional<double> decimal_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// Where a run can start at all: no motor is colder than nothing, or whole where metal boils.
struct StartRange {
  double low, high;
  const char* unit;
};
StartRange range_of_start(const std::string& name) {
  const auto ends = [&name](const std::string& with) {
    return name.size() >= with.size() && name.compare(name.size() - with.size(), with.size(), with) == 0;
  };
  if (ends("_C")) return {-273.15, 5000.0, "degC"};
  if (ends("_deg")) return {-1e7, 1e7, "deg"};
  if (ends("_dps")) return {-1e6, 1e6, "deg/s"};
  return {-1e12, 1e12, ""};
}

std::map<std::string, double> starts_of(const std::vector<std::string>& texts, const gap::Model& model) {
  std::vector<std::string> names{"motor_C", "angle_deg", "rate_dps"};
  if (model.own) {
    names.clear();
    for (const auto& signal : model.own->equations->info()->signals) names.push_back(signal.name);
  }
  std::string expected;
  for (std::size_t i = 0; i < names.size(); ++i)
    expected += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i] + "=";
  std::map<std::string, double> starts;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : decimal_number(text.substr(equals + 1));
    if (!known || !value)
      throw UsageError("--start " + text + ": expected " + expected + " with a decimal number");
    const StartRange range = range_of_start(name);
    if (!(*value >= range.low && *value <= range.high))
      throw UsageError("--start " + text + ": expected " + io::readable(range.low, 5) + " to " +
                       io::readable(range.high, 5) + " " + range.unit);
    if (!starts.emplace(name, *value).second) throw UsageError("--start " + name + " is given twice");
  }
  return starts;
}

// Inputs with missing cells leave holes in what is predicted: nothing fills them here, as the check of a diagnosis does.
void warn_of_holes(const gap::Recording& recording, const gap::Model& model) {
  std::vector<std::string> inputs{"power_param", "drive_A", "voltage_V", "target_deg", "target_dps",
                                  "torque_Nm",   "heat_W",  "supply_V",  "ambient_C"};
  if (model.own) {
    inputs.clear();
    for (const auto& one : model.own->equations->info()->inputs) inputs.push_back(one.name);
  }
  for (const std::string& name : inputs) {
    if (!recording.has(name)) continue;
    const auto known = recording.column(name).array().isFinite();
    const Eigen::Index missing = recording.rows() - known.count();
    if (missing == 0) continue;
    Eigen::Index first = 0;
    while (known[first]) ++first;
    std::fprintf(
        stderr,
        "thermopower-gap: %s: column '%s': %td of %td cells are missing, first at t_s = %s: what is predicted from "
        "there on cannot be trusted, and may be empty; fill them, or cut the recording into runs there\n",
        recording.name.c_str(), name.c_str(), static_cast<std::ptrdiff_t>(missing),
        static_cast<std::ptrdiff_t>(recording.rows()), io::readable(recording.t_s[first]).c_str());
  }
}

int predict(const Arguments& arguments) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  refuse_overlaps(arguments);
  io::OutputFiles outputs;
  outputs.expect(arguments.predictions);
  const gap::Model augmented = io::read_model(arguments.model, catalogue);
  std::vector<gap::Finding> findings;
  std::vector<gap::Recording> recordings =
      read_all(arguments.recordings, column_choices(arguments, augmented), findings);
  const std::map<std::string, double> starts = starts_of(arguments.starts, augmented);
  for (const gap::Recording& one : recordings) warn_of_holes(one, augmented);
  for (gap::Recording& one : recordings) one = io::with_starts(std::move(one), augmented, starts);
  gap::Model bare = augmented;
  bare.effects.clear();
  outputs.put(arguments.predictions,
              io::predictions_csv(bare, augmented, recordings, arguments.horizon_s, catalogue));
  outputs.commit();
  return made;
}

int list_effects(const std::string& model_path) {
  const gap::Catalogue& standard = gap::standard_catalogue();
  gap::Model model;
  if (!model_path.empty()) model = io::read_model(model_path, standard);
  std::fputs(io::catalogue_text(gap::catalogue_of(model, standard).list()).c_str(), stdout);
  return made;
}

int list_columns(const std::string& path, const std::string& proposal) {
  io::OutputFiles outputs;
  if (!proposal.empty()) {
    if (plain_path(proposal) == plain_path(path))
      throw UsageError("'" + path + "' is named twice; an output must not be an input");
    outputs.expect(proposal);
  }
  std::string text;
  std::vector<io::ListedColumn> columns;
  if (io::is_mcap(path)) {
    const io::McapContents contents = io::list_mcap(path);
    text = io::columns_text(contents);
    columns = contents.columns;
  } else if (io::is_sbgc_capture(path)) {
    const io::SbgcCaptureContents contents = io::list_sbgc_capture(path);
    text = io::columns_text(contents);
    columns = contents.columns;
  } else {
    columns = io::list_columns(path);
    text = io::columns_text(columns);
  }
  if (!proposal.empty()) outputs.put(proposal, io::column_map_text(columns));
  outputs.commit();
  std::fputs(text.c_str(), stdout);
  return made;
}

/// Exit status of some work; `fault` receives what is wrong where it throws, as it is told.
template <class Work>
int guarded(Work&& work, std::string& fault) {
  const auto told = [&fault](const char* what, ExitStatus status) {
    fault = std::string("thermopower-gap: ") + what;
    return status;
  };
  try {
    return work();
  } catch (const UsageError& error) {
    return told(error.what(), wrong_usage);
  } catch (const io::InputError& error) {
    return told(error.what(), invalid_input);
  } catch (const io::OutputError& error) {
    return told(error.what(), invalid_input);
  } catch (const gap::InvalidInput& error) {
    return told(error.what(), invalid_input);
  } catch (const std::bad_alloc&) {
    return told("out of memory", invalid_input);
  } catch (const std::exception& error) {
    return told(error.what(), failed);
  }
}

/// Diagnoses one log of a fleet. @return what is wrong; empty where its report is written
std::string diagnose_one(const FleetDiagnosis& asked, Arguments arguments) {
  arguments.model = asked.model;
  arguments.recordings = {asked.recording};
  if (!asked.held_out.empty()) arguments.held_out = {asked.held_out};
  if (!asked.map.empty()) arguments.maps = {asked.map};
  arguments.report = asked.report;
  arguments.html = asked.page;
  arguments.threads = 1;
  arguments.of_fleet = true;
  std::string fault;
  guarded([&] { return diagnose(arguments); }, fault);
  return fault;
}

// No two numbers have the same.
std::string text_of(double value) {
  std::string text = std::to_string(value);
  if (std::stod(text) == value) return text;
  char exact[40];
  std::snprintf(exact, sizeof exact, "%.17g", value);
  return exact;
}

// What Options::validate() takes, as a fault of the usage.
const CLI::Validator seconds(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && value >= 1e-6 && value <= 1e9;
      return fine ? std::string() : "'" + text + "' is not a number of seconds from 1e-6 to 1e9";
    },
    "1e-6..1e9");
// CLI11's own takes nan for a number within.
const CLI::Validator share(
    [](std::string& text) {
      double value = 0.0;
      const bool fine = CLI::detail::lexical_cast(text, value) && value >= 0.0 && value <= 0.5;
      return fine ? std::string() : "'" + text + "' is not a number from 0 to 0.5";
    },
    "0..0.5");
const CLI::Validator not_empty(
    [](std::string& text) { return text.empty() ? std::string("is empty; expected a name") : std::string(); },
    "", "not empty");

// CLI11's own says only that a subcommand is required.
void expect_subcommand(CLI::App& app, const std::string& given) {
  std::vector<std::string> names;
  for (const CLI::App* const one : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(one->get_name());
  if (std::find(names.begin(), names.end(), given) != names.end()) return;
  const std::string nearest = io::nearest_name(given, names);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw UsageError(
      io::excerpt(given) + " is no subcommand" +
      (nearest.empty() ? "; expected one of " : "; did you mean " + nearest + "? Expected one of ") + list);
}

std::string version() {
  using thermopower::Version;
  return std::to_string(Version::major_number()) + "." + std::to_string(Version::minor_number()) + "." +
         std::to_string(Version::patch_number());
}

int run(int count, char** values) {
  CLI::App app(
      "Says where a simulated actuator and the real one part, which effect is missing, and how far the gap shrinks with it.",
      "thermopower-gap");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 a diagnosis was made, 1 a fault of the program itself, 2 wrong usage, 3 unreadable or invalid input, 4 too little data, or data that cannot be believed as they stand.");
  Arguments arguments;

  CLI::App* const diagnosing = app.add_subcommand("diagnose", "find the missing effect");
  diagnosing->add_option("--model", arguments.model, "the simulation under test (JSON)")->required();
  diagnosing
      ->add_option("--recording", arguments.recordings,
                   "a recording to find and fit on (CSV, MCAP, SimpleBGC capture); may be repeated")
      ->required();
  diagnosing->add_option("--heldout", arguments.held_out,
                         "a recording to judge on; without it the last 30 % of each recording");
  diagnosing->add_option("--report", arguments.report, "write the report for machines (JSON)");
  diagnosing->add_option("--html", arguments.html, "write the report for people (one HTML page)");
  diagnosing->add_option("--predictions", arguments.predictions, "write held-out predictions (CSV)");
  diagnosing->add_option("--augmented", arguments.augmented, "write the model with what was found (JSON)");
  diagnosing->add_option("--header", arguments.header, "write the same as a C++11 header for firmware");
  diagnosing->add_option("--without", arguments.without,
                         "remove an effect from the catalogue; may be repeated");
  diagnosing->add_option("--horizon", arguments.horizon_s, "length of the axis' windows in s")
      ->check(seconds)
      ->capture_default_str();
  diagnosing
      ->add_option("--tolerance", arguments.tolerance,
                   "relative shrinkage of the gap below which nobody cares")
      ->check(share)
      ->capture_default_str();
  diagnosing
      ->add_option("--threads", arguments.threads,
                   "worker threads; 0: one per core. The result does not depend on it")
      ->check(CLI::Range(0u, 1024u))
      ->capture_default_str();
  diagnosing->add_option("--seed", arguments.seed, "of the bootstrap")->capture_default_str();

  CLI::App* const predicting = app.add_subcommand("predict", "simulate a recording with a model");
  predicting->add_option("--model", arguments.model, "a model, with effects or without (JSON)")->required();
  predicting
      ->add_option("--recording", arguments.recordings,
                   "a recording (CSV, MCAP, SimpleBGC capture); may be repeated")
      ->required();
  predicting->add_option("--predictions", arguments.predictions, "where the predictions go (CSV)")
      ->required();
  predicting->add_option("--start", arguments.starts,
                         "where a run starts, as in motor_C=40 (also angle_deg, rate_dps); without it as "
                         "measured, else at the air's temperature and at rest");
  predicting->add_option("--horizon", arguments.horizon_s, "length of the axis' windows in s")
      ->check(seconds)
      ->capture_default_str();

  CLI::App* const checking = app.add_subcommand(
      "check", "say what is wrong with recordings, and what they can show; nothing is fitted");
  checking->add_option("--model", arguments.model, "the simulation under test (JSON)")->required();
  checking
      ->add_option("--recording", arguments.recordings,
                   "a recording (CSV, MCAP, SimpleBGC capture); may be repeated")
      ->required();
  checking->add_option("--heldout", arguments.held_out, "a recording to judge on; may be repeated");
  checking->add_option("--report", arguments.report, "write the same for machines (JSON)");
  checking->add_option("--horizon", arguments.horizon_s, "length of the axis' windows in s")
      ->check(seconds)
      ->capture_default_str();
  for (CLI::App* const one : {diagnosing, checking})
    one->add_flag("--as-recorded", arguments.as_recorded,
                  "mask and cut nothing: say what is wrong with the data, and use them all the same");
  for (CLI::App* const one : {diagnosing, predicting, checking})
    one->add_option("--column", arguments.columns,
                    "NAME=HEADER[:UNIT]: which column of the files it is, and in which unit "
                    "(motor_C=temp:degF, t_s=stamp:ms, drive_A=current:-mA); may be repeated");
  for (CLI::App* const one : {diagnosing, predicting, checking})
    one->add_option("--map", arguments.maps, "a file of such lines, as 'columns FILE --proposal' writes it");

  CLI::App* const exporting =
      app.add_subcommand("export", "write a model in the words of other simulators, or as a header");
  exporting->add_option("--model", arguments.model, "a model, with effects or without (JSON)")->required();
  for (CLI::App* const one : {diagnosing, exporting}) {
    one->add_option("--mjcf", arguments.mjcf, "write the axis as a model of MuJoCo (MJCF)");
    one->add_option("--urdf", arguments.urdf, "write the axis as a joint (URDF)");
  }
  exporting->add_option("--header", arguments.header, "write a C++11 header for firmware");

  std::string listed, proposal;
  CLI::App* const columns =
      app.add_subcommand("columns", "list what is in a file, and propose what its columns are");
  columns->add_option("file", listed, "a recording (CSV, MCAP, SimpleBGC capture), - for standard input")
      ->required();
  columns->add_option("--proposal", proposal, "write the proposals as a mapping file for --map");

  FleetArguments fleet;
  CLI::App* const many = app.add_subcommand(
      "fleet", "diagnose every log of a table, several at a time; the same command resumes");
  many->add_option(
          "manifest", fleet.manifest,
          "the logs (CSV): log, model, and where needed unit, time, heldout, map; paths from its folder on")
      ->required();
  many->add_option("--out", fleet.out, "folder of the results: reports/, fleet.html, logs.csv and others")
      ->required();
  many->add_option("--workers", fleet.workers,
                   "processes at a time; 0: one per core. The results do not depend on it")
      ->check(CLI::Range(0u, 1024u))
      ->capture_default_str();
  many->add_flag("!--no-pages", fleet.pages, "write no page (HTML) for each log");
  many->add_option("--column", arguments.columns, "as for diagnose, of every log");
  many->add_option("--without", arguments.without, "as for diagnose");
  CLI::Option* const horizon =
      many->add_option("--horizon", arguments.horizon_s, "length of the axis' windows in s")->check(seconds);

  CLI::App* const listing = app.add_subcommand("effects", "list the catalogue");
  listing->add_option("--model", arguments.model,
                      "a model with effects of its own, such as a network (JSON)");

  for (CLI::App* const subcommand : app.get_subcommands([](const CLI::App*) { return true; }))
    for (CLI::Option* const option : subcommand->get_options([](const CLI::Option*) { return true; }))
      if (option->get_expected_min() > 0) option->check(not_empty);

  if (count > 1 && values[1][0] != '-') expect_subcommand(app, values[1]);
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? made : wrong_usage;
  }
  if (*listing) return list_effects(arguments.model);
  if (*checking) return check(arguments);
  if (*many) {
    check_ids(arguments.without, gap::standard_catalogue());
    for (const std::string& one : arguments.columns) expect_choice(one);
    for (const std::string& one : arguments.columns)
      fleet.options.insert(fleet.options.end(), {"--column", one});
    for (const std::string& one : arguments.without)
      fleet.options.insert(fleet.options.end(), {"--without", one});
    if (horizon->count() > 0)
      fleet.options.insert(fleet.options.end(), {"--horizon", text_of(arguments.horizon_s)});
    fleet.diagnose = [&arguments](const FleetDiagnosis& asked) { return diagnose_one(asked, arguments); };
    return run_fleet(fleet);
  }
  if (*columns) return list_columns(listed, proposal);
  if (*exporting) return export_model(arguments);
  return *predicting ? predict(arguments) : diagnose(arguments);
}

}  // namespace

int main(int count, char** values) {
  keep_memory();
  std::string fault;
  const int status = guarded([&] { return run(count, values); }, fault);
  if (!fault.empty()) {
    std::fprintf(stderr, "%s\n", fault.c_str());
    return status;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fputs("thermopower-gap: standard output cannot be written\n", stderr);
    return invalid_input;
  }
  return status;
}
