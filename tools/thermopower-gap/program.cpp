// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "nearest_name.hpp"
#include "program.hpp"
#include "text_file.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/io.hpp>
#include <thermopower/plant/plant.hpp>
#include <thermopower/plant/plant_info.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

// Columns that a plant of one's own reads by names of its own.
std::vector<std::string> own_columns(const gap::Model& model) {
  std::vector<std::string> names;
  if (!model.own) return names;
  const auto& info = *model.own->equations->info();
  for (const auto& one : info.inputs) names.push_back(one.name);
  for (const auto& one : info.signals) names.push_back(one.name);
  return names;
}

}  // namespace

// What stands on the command line goes before what a mapping file says of the same name.
io::ReadOptions reading(const Arguments& arguments, const gap::Model& model) {
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
  try {
    for (const auto& text : arguments.columns) {
      const io::ColumnChoice choice = io::parse_column_choice(text);
      if (const std::string wrong = io::unknown_name(choice, own); !wrong.empty())
        throw UsageError("--column " + text + ": " + wrong);
      if (const auto known = find(choice.name); known != choices.end()) *known = choice;
      else choices.push_back(choice);
    }
  } catch (const io::InputError& error) {
    throw UsageError(error.what());
  }
  io::ReadOptions options = io::read_options(model, std::move(choices));
  options.rows_per_s = arguments.rows_per_s;
  if (arguments.has_ambient) options.constants.emplace_back("ambient_C", arguments.ambient_C);
  if (arguments.has_supply) options.constants.emplace_back("supply_V", arguments.supply_V);
  for (const std::string& text : arguments.constants) {
    const std::size_t equals = text.find('=');
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const bool fine = equals != std::string::npos && equals > 0 &&
                      std::from_chars(text.data() + equals + 1, end, value).ptr == end &&
                      equals + 1 < text.size() && std::isfinite(value);
    const std::string name = text.substr(0, equals);
    if (!fine) throw UsageError("--constant " + text + ": expected NAME=NUMBER, such as airspeed_mps=2.5");
    if (name == "t_s" || name == "run")
      throw UsageError("--constant " + text + ": " + name + " is not a constant");
    if (const std::string wrong = io::unknown_name({name, "a column"}, own); !wrong.empty())
      throw UsageError("--constant " + text + ": " + wrong);
    if (name == "ambient_C" && arguments.has_ambient)
      throw UsageError("--constant " + text + ": ambient_C is given by --ambient, too");
    if (name == "supply_V" && arguments.has_supply)
      throw UsageError("--constant " + text + ": supply_V is given by --supply, too");
    // The last one counts, as of a column.
    const auto before = std::find_if(options.constants.begin(), options.constants.end(),
                                     [&](const auto& one) { return one.first == name; });
    if (before != options.constants.end()) before->second = value;
    else options.constants.emplace_back(name, value);
  }
  return options;
}

io::Provenance provenance_of(const Arguments& arguments) {
  io::Provenance made_of{arguments.model, arguments.recordings, arguments.held_out, {}, io::today()};
  const Arguments standard;
  const auto number = [&made_of](const char* option, double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%s %g", option, value);
    made_of.options.emplace_back(text);
  };
  const auto each = [&made_of](const char* option, const std::vector<std::string>& values,
                               bool is_path = false) {
    for (const std::string& one : values)
      made_of.options.push_back(std::string(option) + " " + (is_path ? io::path_for_others(one) : one));
  };
  if (arguments.horizon_s != standard.horizon_s) number("--horizon", arguments.horizon_s);
  if (arguments.tolerance != standard.tolerance) number("--tolerance", arguments.tolerance);
  if (arguments.seed != standard.seed) number("--seed", arguments.seed);
  if (arguments.as_recorded) made_of.options.emplace_back("--as-recorded");
  each("--without", arguments.without);
  each("--map", arguments.maps, true);
  each("--column", arguments.columns);
  if (arguments.rows_per_s > 0.0) number("--rate", arguments.rows_per_s);
  if (arguments.has_ambient) number("--ambient", arguments.ambient_C);
  if (arguments.has_supply) number("--supply", arguments.supply_V);
  each("--constant", arguments.constants);
  return made_of;
}

// A choice of a fleet, before the models are known.
void expect_choice(const std::string& text) {
  try {
    io::parse_column_choice(text);
  } catch (const io::InputError& error) {
    throw UsageError(error.what());
  }
}

std::vector<gap::Recording> read_all(const std::vector<std::string>& paths, const io::ReadOptions& how,
                                     std::vector<gap::Finding>& findings) {
  std::vector<gap::Recording> list;
  for (const auto& path : paths) {
    io::RecordingFile file = io::read_recording(path, how);
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

// With a model --mjcf and --urdf are outputs, without one a robot is read from them: mistaken, it would be written over.
constexpr const char* on_top_of_exports = "Units: SI, radians; the control is";
void refuse_other_robots(const char* option, const std::string& path) {
  std::error_code error;
  if (path.empty() || !std::filesystem::is_regular_file(path, error)) return;
  const std::string text = read_text(path);
  const bool is_robot = text.find("<mujoco") != std::string::npos || text.find("<robot") != std::string::npos;
  if (is_robot && text.find(on_top_of_exports) == std::string::npos)
    throw UsageError(
        std::string(option) + " " + path +
        ": holds a robot that this program did not write; with --model the axis is written there. Give " +
        "another name, or leave --model out to diagnose that robot");
}

// Two outputs in one file, or an output over an input, would lose one of them.
void refuse_overlaps(const Arguments& arguments) {
  refuse_other_robots("--mjcf", arguments.mjcf);
  refuse_other_robots("--urdf", arguments.urdf);
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
    std::vector<std::string> known;
    for (const auto& effect : catalogue.list()) known.push_back(effect.id);
    const std::string nearest = io::nearest_name(id, known);
    throw UsageError("--without: there is no effect '" + id + "'; " +
                     (nearest.empty() ? "" : "did you mean " + nearest + "? ") +
                     "'thermopower-gap effects' lists them");
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

int guarded(const std::function<int()>& work, std::string& fault) {
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
