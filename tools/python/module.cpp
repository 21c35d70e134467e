// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// The part of the Python module that is C++: what crosses is text (JSON) and arrays. The package around it,
// thermopower/__init__.py, is what users see.

#include "dual_numbers.hpp"
#include "fleet.hpp"
#include "own_effect.hpp"
#include "nearest_name.hpp"
#include "own_plant.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/gap/observe/heater_duty.hpp>
#include <thermopower/design/design.hpp>
#include <thermopower/io.hpp>
#include <thermopower/io/design_files.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace py = pybind11;
namespace design = thermopower::design;
namespace gap = thermopower::gap;
namespace plant = thermopower::plant;
namespace io = thermopower::io;

namespace {

using Columns = std::vector<std::pair<std::string, Eigen::VectorXd>>;
using Run = std::pair<Eigen::Index, std::string>;  // first row, label

io::RecordingFile recording_of(const std::string& name, const Eigen::VectorXd& t_s,
                               const std::vector<Run>& runs, const Columns& columns) {
  gap::Recording recording;
  recording.name = name;
  recording.t_s = t_s;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Eigen::Index end = i + 1 < runs.size() ? runs[i + 1].first : t_s.size();
    recording.runs.push_back({runs[i].first, end, runs[i].second});
  }
  for (const auto& [column, values] : columns) recording.set(column, values);
  if (const auto problem = recording.validate())
    throw io::InputError("recording '" + name + "': " + *problem);
  return {recording, {}};
}

/// What files do not say of themselves, and what of it a model says.
io::ReadOptions how_to_read(const std::vector<std::string>& choices,
                            const std::vector<std::pair<std::string, double>>& constants, double rows_per_s,
                            const gap::Model* model) {
  io::ReadOptions options = model != nullptr ? io::read_options(*model) : io::ReadOptions();
  for (const std::string& text : choices) options.choices.push_back(io::parse_column_choice(text));
  options.constants = constants;
  options.rows_per_s = rows_per_s;
  return options;
}

/// The recordings of files. Adds to `findings` what was noticed while reading them.
std::vector<gap::Recording> recordings_of(std::vector<io::RecordingFile> files,
                                          std::vector<gap::Finding>& findings) {
  std::vector<gap::Recording> list;
  for (io::RecordingFile& one : files) {
    list.push_back(std::move(one.recording));
    findings.insert(findings.end(), one.findings.begin(), one.findings.end());
  }
  return list;
}

gap::Model model_of(const std::string& json, const gap::Catalogue& catalogue = gap::standard_catalogue()) {
  return io::parse_model("model", json, catalogue);
}

/// The standard catalogue, and effects whose equations are Python functions.
gap::Catalogue catalogue_with(const std::vector<py::dict>& effects) {
  gap::Catalogue catalogue = gap::standard_catalogue();
  for (const py::dict& one : effects) thermopower::python::add_effect(catalogue, one);
  return catalogue;
}

/// Does C++ work in a thread of its own while this one looks for Ctrl-C, which tells the work to stop. Called with the
/// Python lock, which the work does not have.
template <class Work>
auto until_interrupted(std::atomic<bool>& stop, Work&& work) {
  auto running = std::async(std::launch::async, std::forward<Work>(work));
  bool interrupted = false;
  for (bool done = false; !done;) {
    {
      const py::gil_scoped_release released;
      done = running.wait_for(std::chrono::milliseconds(30)) == std::future_status::ready;
    }
    if (!interrupted && PyErr_CheckSignals() != 0) {
      PyErr_Clear();  // raised below, when nothing uses the recordings any more
      interrupted = stop = true;
    }
  }
  if (interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return running.get();
}

using DesignTexts = std::tuple<std::string, std::string, std::string, std::string, std::string>;

/// The next experiment that a report asks for: its ending, what a person reads, the schedule, the schedule for firmware, a page.
DesignTexts designed(const std::string& report, const std::string& limits, unsigned seed,
                     const gap::Catalogue& catalogue) {
  const py::gil_scoped_release released;
  const design::DiagnosedGap diagnosed = io::parse_report("report", report, catalogue);
  const design::Limits within = io::parse_limits("limits", limits);
  design::DesignOptions options;
  options.seed = seed;
  const design::Design design = design::design_experiment(diagnosed, within, options, catalogue);
  const bool has_schedule = design.ending == design::Ending::schedule;
  return {to_string(design.ending), io::design_summary(design, within),
          has_schedule ? io::schedule_csv(design) : std::string(),
          has_schedule ? io::schedule_header(design, within) : std::string(),
          io::design_html(design, within, diagnosed.model.name)};
}

/// A diagnosis with what its files are written from.
struct Result {
  gap::Diagnosis diagnosis;
  gap::Catalogue catalogue;
  gap::Model model;  ///< as it was given
  std::vector<gap::Recording> held_out;

  std::vector<plant::EffectInfo> effects() const {
    return gap::catalogue_of(diagnosis.augmented, catalogue).list();
  }
  std::string report() const {
    // A plant that is a function has no file.
    return model.own ? io::report_json(diagnosis, effects()) : io::report_json(diagnosis, model, effects());
  }
  std::string html() const { return io::report_html(diagnosis, model.name, effects(), held_out); }
  std::string augmented() const { return io::to_json(diagnosis.augmented); }
  std::string recalibrated() const { return io::to_json(diagnosis.recalibrated); }
  std::string summary() const { return io::summary(diagnosis, effects()); }
  DesignTexts design(const std::string& limits, unsigned seed) const {
    return designed(report(), limits, seed, catalogue);
  }
  std::string markdown() const { return io::summary_markdown(diagnosis, model.name, effects()); }
  std::pair<std::string, std::vector<std::string>> mjcf() const {
    io::SimulatorFile made = io::mjcf(diagnosis.augmented, io::one_sentence(diagnosis), catalogue);
    return {made.text, made.left_out};
  }
  std::pair<std::string, std::vector<std::string>> urdf() const {
    io::SimulatorFile made = io::urdf(diagnosis.augmented, io::one_sentence(diagnosis), catalogue);
    return {made.text, made.left_out};
  }
  std::pair<std::string, std::vector<std::string>> header() const {
    io::MotorModelHeader made =
        io::motor_model_header(diagnosis.augmented, io::one_sentence(diagnosis), catalogue);
    return {made.text, made.left_out};
  }
  py::list series() const {
    py::list list;
    for (const gap::SignalSeries& one : diagnosis.series) {
      py::dict entry;
      entry["signal"] = to_string(one.signal);
      entry["unit"] = one.unit;
      entry["recording"] = one.recording;
      entry["t_s"] = one.t_s;
      entry["measured"] = one.measured;
      entry["baseline"] = one.baseline;
      entry["recalibrated"] = one.recalibrated;
      entry["augmented"] = one.augmented;
      list.append(entry);
    }
    return list;
  }
};

/// A misspelt id would silently remove nothing.
void expect_effects(const std::vector<std::string>& ids, const gap::Catalogue& catalogue) {
  for (const std::string& id : ids) {
    if (plant::is_calibration(id) || catalogue.find(id) != nullptr) continue;
    std::vector<std::string> known;
    for (const auto& effect : catalogue.list()) known.push_back(effect.id);
    const std::string nearest = io::nearest_name(id, known);
    throw io::InputError(
        "without: there is no effect '" + id + "'; " +
        (nearest.empty() ? "print(thermopower.effects()) lists them" : "did you mean " + nearest + "?"));
  }
}

/// A misspelt start would silently start nothing.
void expect_starts(const std::map<std::string, double>& starts, const gap::Model& model) {
  if (model.own) return;  // tells by itself
  for (const auto& [name, value] : starts) {
    const bool known = name == "motor_C" || name == "current_A" || name == "angle_deg" || name == "rate_dps";
    if (!known)
      throw io::InputError("start: there is no '" + name +
                           "'; expected motor_C, current_A, angle_deg or rate_dps");
  }
}

Result diagnose_recordings(const gap::Model& model, const std::vector<py::dict>& effects,
                           std::vector<io::RecordingFile> train_files,
                           std::vector<io::RecordingFile> held_out_files, gap::Options options,
                           const io::ReadOptions& how) {
  options.validate();
  std::vector<gap::Finding> findings;
  std::vector<gap::Recording> train = recordings_of(std::move(train_files), findings),
                              held_out = recordings_of(std::move(held_out_files), findings);
  Result result;
  result.catalogue = catalogue_with(effects);
  expect_effects(options.without, gap::catalogue_of(model, result.catalogue));
  if (held_out.empty()) {
    for (gap::Recording& recording : train) {
      auto [first, last] = gap::split(model, std::move(recording), options.held_out_fraction);
      recording = std::move(first);
      held_out.push_back(std::move(last));
    }
  }
  std::atomic<bool> stop{false};
  options.stop = &stop;
  result.diagnosis = until_interrupted(
      stop, [&] { return gap::diagnose(model, train, held_out, options, result.catalogue); });
  result.diagnosis.findings.insert(result.diagnosis.findings.end(), findings.begin(), findings.end());
  io::put_remedies_in_force(result.diagnosis, how, io::Caller::python);
  result.model = model;
  result.held_out = std::move(held_out);
  return result;
}

// For machines and for people.
std::pair<std::string, std::string> check(const gap::Model& model, const std::vector<py::dict>& effects,
                                          std::vector<io::RecordingFile> train_files,
                                          std::vector<io::RecordingFile> held_out_files,
                                          const gap::Options& options, const io::ReadOptions& how) {
  options.validate();
  const gap::Catalogue catalogue = catalogue_with(effects);
  const py::gil_scoped_release released;
  std::vector<gap::Finding> findings;
  const std::vector<gap::Recording> train = recordings_of(std::move(train_files), findings),
                                    held_out = recordings_of(std::move(held_out_files), findings);
  gap::DataReport report = gap::check_data(model, train, held_out, options, catalogue);
  report.findings.insert(report.findings.end(), findings.begin(), findings.end());
  io::put_remedies_in_force(report, how, io::Caller::python);
  return {io::check_json(report), io::check_text(report)};
}

using Signals = std::vector<std::pair<std::string, Eigen::VectorXd>>;

// Each model on each recording's own thread of a few; an exception in one is the batch's.
std::vector<Signals> simulate(const std::vector<gap::Model>& models, const std::vector<py::dict>& effects,
                              const std::vector<io::RecordingFile>& recordings,
                              const std::map<std::string, double>& starts, double horizon_s, bool from_inputs,
                              unsigned threads) {
  const gap::Catalogue catalogue = catalogue_with(effects);
  const py::gil_scoped_release released;
  gap::SimulationOptions options;
  options.horizon_s = horizon_s;
  const std::size_t count = models.size() * recordings.size();
  std::vector<Signals> all(count);
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        const gap::Model& model = models[i / recordings.size()];
        gap::Recording recording = recordings[i % recordings.size()].recording;
        if (from_inputs) expect_starts(starts, model);
        if (from_inputs) recording = io::with_starts(std::move(recording), model, starts);
        for (auto& one : gap::simulate(model, recording, options, catalogue))
          all[i].emplace_back(to_string(one.signal), std::move(one.values));
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < std::min<std::size_t>(std::max(threads, 1u), count); ++i)
    workers.emplace_back(work);
  work();
  for (std::thread& one : workers) one.join();
  for (const std::exception_ptr& one : errors)
    if (one) std::rethrow_exception(one);
  return all;
}

/// A fleet, in processes that are forked here. @return whether every log has a report
bool fleet(const std::string& manifest, const std::string& out, unsigned workers, bool pages, Arguments each,
           std::optional<double> horizon_s) {
  expect_effects(each.without, gap::standard_catalogue());
  for (const std::string& one : each.columns) io::parse_column_choice(one);
  gap::Options checked;
  if (horizon_s) checked.horizon_s = each.horizon_s = *horizon_s;
  checked.validate();
  FleetArguments work;
  work.manifest = manifest;
  work.out = out;
  work.workers = workers;
  work.pages = pages;
  work.quiet = true;
  work.options = options_of_fleet(each, horizon_s.has_value());
  work.diagnose = [&each](const FleetDiagnosis& one) { return diagnose_of_fleet(one, each); };
  work.stop = [] {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() == 0) return false;
    PyErr_Clear();  // raised below
    return true;
  };
  try {
    const py::gil_scoped_release released;
    return run_fleet(work) == made;
  } catch (const FleetStopped&) {
  }
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

}  // namespace

PYBIND11_MODULE(_thermopower, module) {
  using released = py::call_guard<py::gil_scoped_release>;
  // Where a module of one's own turned a bad value down, and where a file or an argument cannot be read.
  py::register_exception<gap::InvalidInput>(module, "InvalidInput", PyExc_ValueError);
  py::register_exception<io::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<io::OutputError>(module, "OutputError", PyExc_OSError);
  py::class_<io::RecordingFile>(module, "Recording")
      .def(py::init(&recording_of))
      .def_property_readonly("name", [](const io::RecordingFile& one) { return one.recording.name; })
      .def_property_readonly("rows", [](const io::RecordingFile& one) { return one.recording.rows(); });
  py::class_<io::ReadOptions>(module, "Reading").def(py::init(&how_to_read));
  module.def(
      "read_recording",
      [](const std::string& path, const io::ReadOptions& how) { return io::read_recording(path, how); },
      released());
  module.def("choice_of", [](const std::string& text) {
    const io::ColumnChoice choice = io::parse_column_choice(text);
    return std::make_pair(choice.name, choice.header);
  });
  module.def("chosen_values", [](const std::string& text, Eigen::VectorXd values, const io::ReadOptions& how,
                                 const Eigen::VectorXd& supply_V) {
    using Needs = io::ColumnChoice::Needs;
    const io::ColumnChoice choice = io::parse_column_choice(text);
    double scale = 1.0;
    const bool has_supply = supply_V.size() == values.size();
    if (choice.needs == Needs::torque_constant) scale = 1.0 / how.torque_constant_Nm_per_A;
    if (choice.needs == Needs::supply && !has_supply) scale = how.nominal_V;
    if (!std::isfinite(scale) || scale == 0.0)
      throw io::InputError("columns: " + text + ": " +
                           (choice.needs == Needs::supply
                                ? "a share of the supply needs supply_V, or /supply/nominal_V in the model"
                                : "a torque needs /axis/torque_constant_Nm_per_A in the model"));
    for (Eigen::Index row = 0; row < values.size(); ++row)
      values[row] = io::value_of(choice, values[row]) *
                    (choice.needs == Needs::supply && has_supply ? supply_V[row] : scale);
    return values;
  });
  py::class_<gap::Options>(module, "Options")
      .def(py::init())
      .def_readwrite("horizon_s", &gap::Options::horizon_s)
      .def_readwrite("tolerance", &gap::Options::tolerance)
      .def_readwrite("held_out_fraction", &gap::Options::held_out_fraction)
      .def_readwrite("effects_at_once", &gap::Options::effects_at_once)
      .def_readwrite("without", &gap::Options::without)
      .def_readwrite("as_recorded", &gap::Options::as_recorded)
      .def_readwrite("threads", &gap::Options::threads)
      .def_readwrite("seed", &gap::Options::seed);
  py::class_<Result>(module, "Result")
      .def("report", &Result::report)
      .def("html", &Result::html)
      .def("augmented", &Result::augmented)
      .def("augmented_model", [](const Result& one) { return one.diagnosis.augmented; })
      .def("recalibrated_model", [](const Result& one) { return one.diagnosis.recalibrated; })
      .def("recalibrated", &Result::recalibrated)
      .def("summary", &Result::summary)
      .def("header", &Result::header)
      .def("markdown", &Result::markdown)
      .def("design", &Result::design)
      .def("mjcf", &Result::mjcf)
      .def("urdf", &Result::urdf)
      .def("series", &Result::series);
  thermopower::python::bind_dual<plant::Dual>(module, "Dual");
  thermopower::python::bind_dual<plant::WideDual>(module, "WideDual");
  thermopower::python::bind_traced_number(module);
  thermopower::python::bind_added_friction<double>(module, "AddedFriction");
  thermopower::python::bind_added_friction<plant::Expression>(module, "AddedFrictionOfTracedNumbers");
  thermopower::python::bind_added_friction<plant::Dual>(module, "AddedFrictionOfDuals");
  thermopower::python::bind_added_friction<plant::WideDual>(module, "AddedFrictionOfWideDuals");
  py::class_<gap::Model>(module, "Model")
      .def_readonly("name", &gap::Model::name)
      .def("constants", &thermopower::python::constants_of)
      .def("effects", [](const gap::Model& model) { return model.effects; })
      .def("with_", &thermopower::python::changed);
  module.def("model", [](const std::string& json, const std::vector<py::dict>& effects) {
    return model_of(json, catalogue_with(effects));
  });
  module.def("own_plant", &thermopower::python::own_plant);
  module.def("diagnose", &diagnose_recordings);
  module.def("check", &check);
  module.def("simulate", &simulate);
  module.def("fleet", [](const std::string& manifest, const std::string& out, unsigned workers, bool pages,
                         std::vector<std::string> columns, std::vector<std::string> without,
                         std::optional<double> horizon_s) {
    Arguments each;
    each.columns = std::move(columns);
    each.without = std::move(without);
    return fleet(manifest, out, workers, pages, std::move(each), horizon_s);
  });
  module.def("is_traced", &thermopower::python::is_traced);
  module.def("effects", [] { return io::catalogue_text(gap::standard_catalogue().list()); });
  module.def("normalised", [](const std::string& model) { return io::to_json(model_of(model)); });
  module.def("explain", [](const std::string& code) {
    const auto page = io::code_page(code);
    if (page) return io::to_text(*page);
    const std::string nearest = io::nearest_name(code, io::known_codes());
    throw io::InputError("explain: there is no code '" + code + "'" +
                         (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  });
  // A pickled diagnosis has its report, and the catalogue of the library.
  module.def("design", [](const std::string& report, const std::string& limits, unsigned seed) {
    return designed(report, limits, seed, gap::standard_catalogue());
  });
  module.def("compare", [](const std::string& a, const std::string& b) {
    return io::comparison({"the first", a}, {"the second", b});
  });
  module.def(
      "columns",
      [](const std::string& path, const std::string& joint) {
        const io::LogContents contents = io::list_log(path, joint);
        std::vector<std::pair<std::string, std::string>> proposed;
        for (const io::ListedColumn& one : contents.columns)
          if (!one.proposed.empty())
            proposed.emplace_back(one.proposed, one.header + (one.unit.empty() ? "" : ":" + one.unit));
        return std::make_pair(io::columns_text(contents), proposed);
      },
      released());
  module.attr("version") = io::version_text();
  module.attr("known_columns") = io::known_columns();
}
