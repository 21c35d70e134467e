// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The diagnosis for a page: files stand in the memory of the program, the answer is JSON. The page's script is
// try_it_here.js, which runs this in a worker; neither asks for anything from elsewhere.
#include <thermopower/thermopower.hpp>

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/io/remedy.hpp>
#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/gap/observe/heater_duty.hpp>

#include "../io-library/shell_words.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace tp = thermopower;
namespace gap = thermopower::gap;
namespace io = thermopower::io;

// A motor on the bench, as in examples/11_known_gap: its winding is copper.
std::string example_csv(int rows, double tempco_per_K, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> level(0, 12), length(4, 24);
  std::normal_distribution<double> thermometer_K(0.0, 0.1), ammeter_A(0.0, 0.004);
  const tp::CurrentModel<tp::OhmicCurrent<double>> winding({12.0, tempco_per_K, 25.0});
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>, tp::ExactStep> motor(
      {{60.0}, {0.11}}, 24.0);
  std::string csv = "t_s,power_param,supply_V,ambient_C,current_A,motor_C\n";
  int power_param = 0, left = 2;
  for (int row = 0; row < rows; ++row) {
    if (left-- == 0) {
      power_param = 20 * level(random);
      left = length(random);
    }
    const auto drawn = winding.at_power(power_param, 12.0, motor.hottest_C());
    char line[96];
    std::snprintf(line, sizeof line, "%d,%d,12,24,%.4f,%.2f\n", 5 * row, power_param,
                  drawn.current_A + ammeter_A(random), motor.hottest_C() + thermometer_K(random));
    csv += line;
    motor.step({drawn.winding_power_W, drawn.v_rms_V, {24.0, 0.0}}, 5.0);
  }
  return csv;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  for (std::size_t at = 0, end; at < text.size(); at = end + 1) {
    end = std::min(text.find('\n', at), text.size());
    if (end > at) list.push_back(text.substr(at, end - at));
  }
  return list;
}

// The curves of the held-out data, for the page's slider between the two simulations.
nlohmann::ordered_json curves(const gap::Diagnosis& diagnosis) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto numbers = [](const Eigen::VectorXd& values) {
    return std::vector<double>(values.begin(), values.end());
  };
  for (const gap::SignalSeries& one : diagnosis.series)
    list.push_back({{"signal", to_string(one.signal)},
                    {"unit", one.unit},
                    {"t_s", numbers(one.t_s)},
                    {"measured", numbers(one.measured)},
                    {"off", numbers(one.baseline)},
                    {"on", numbers(one.augmented)}});
  return list;
}

// How a page's recordings are read and judged.
struct PageOptions {
  io::ReadOptions reading;
  double horizon_s = gap::Options().horizon_s;
};

// What the page's mapping says: lines of a mapping file, and of options as a finding says to type. The last one counts.
PageOptions page_options(const gap::Model& model, const std::string& mapping) {
  PageOptions options{io::read_options(model)};
  std::vector<io::ColumnChoice>& choices = options.reading.choices;
  const auto choose = [&](const io::ColumnChoice& choice) {
    const auto before = std::find_if(choices.begin(), choices.end(),
                                     [&](const auto& one) { return one.name == choice.name; });
    if (before != choices.end()) *before = choice;
    else choices.push_back(choice);
  };
  const auto set = [&](const std::string& name, const std::string& number) {
    auto& constants = options.reading.constants;
    constants.erase(std::remove_if(constants.begin(), constants.end(),
                                   [&](const auto& one) { return one.first == name; }),
                    constants.end());
    constants.emplace_back(name, std::stod(number));
  };
  std::string map;
  for (const std::string& line : lines(mapping)) {
    const std::vector<std::string> given = io::shell_words(line);
    if (given.empty() || given.front().compare(0, 2, "--") != 0) {
      map += line + "\n";
      continue;
    }
    for (std::size_t i = 0; i < given.size(); i += 2) {
      const std::string& name = given[i];
      if (i + 1 == given.size()) throw io::InputError("the mapping: " + name + " has no value");
      const std::string& value = given[i + 1];
      try {
        const std::size_t equals = value.find('=');
        if (name == "--column") choose(io::parse_column_choice(value));
        else if (name == "--ambient") set("ambient_C", value);
        else if (name == "--supply") set("supply_V", value);
        else if (name == "--constant" && equals != std::string::npos)
          set(value.substr(0, equals), value.substr(equals + 1));
        else if (name == "--rate") options.reading.rows_per_s = std::stod(value);
        else if (name == "--horizon") options.horizon_s = std::stod(value);
        else
          throw io::InputError(
              "the mapping: there is no " + name +
              " on this page; expected --column, --ambient, --supply, --constant, --rate or --horizon");
      } catch (const std::logic_error&) {  // of std::stod
        throw io::InputError("the mapping: " + name + " " + value + ": expected a number");
      }
    }
  }
  if (map.find('=') != std::string::npos) {
    std::vector<io::ColumnChoice> of_options;
    of_options.swap(choices);
    choices = io::parse_column_map("the mapping", map);
    for (const io::ColumnChoice& one : of_options) choose(one);
  }
  return options;
}

nlohmann::ordered_json diagnosed(const std::string& model_path, const std::vector<std::string>& training,
                                 const std::vector<std::string>& held_out_paths, const std::string& mapping) {
  const gap::Catalogue& catalogue = gap::standard_catalogue();
  const gap::Model model = io::read_model(model_path, catalogue);
  const PageOptions page = page_options(model, mapping);
  const io::ReadOptions& how = page.reading;
  std::vector<gap::Finding> findings;
  std::size_t rows = 0;
  const auto read_all = [&](const std::vector<std::string>& paths) {
    std::vector<gap::Recording> all;
    for (const std::string& path : paths) {
      io::RecordingFile file = io::read_recording(path, how);
      findings.insert(findings.end(), file.findings.begin(), file.findings.end());
      rows += static_cast<std::size_t>(file.recording.t_s.size());
      all.push_back(std::move(file.recording));
    }
    return all;
  };
  std::vector<gap::Recording> recordings = read_all(training), held_out = read_all(held_out_paths);
  gap::Options options;  // one thread: what runs in a page has no other
  options.horizon_s = page.horizon_s;
  if (held_out.empty())
    for (gap::Recording& one : recordings) {
      auto [first, last] = gap::split(model, std::move(one), options.held_out_fraction);
      one = std::move(first);
      held_out.push_back(std::move(last));
    }
  const auto since = std::chrono::steady_clock::now();
  gap::Diagnosis diagnosis = gap::diagnose(model, recordings, held_out, options, catalogue);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  diagnosis.findings.insert(diagnosis.findings.end(), findings.begin(), findings.end());
  io::put_remedies_in_force(diagnosis, how);
  return {
      {"verdict", to_string(diagnosis.verdict)},
      {"curves", curves(diagnosis)},
      {"rows", rows},
      {"seconds", seconds},
      {"summary", io::summary(diagnosis)},
      {"report", io::report_json(diagnosis)},
      {"html", io::report_html(diagnosis, model.name, gap::catalogue_of(model, catalogue).list(), held_out)}};
}

std::string answer;

}  // namespace

extern "C" {

/// The example's recording as CSV.
const char* thermopower_example(int rows, double tempco_per_K, unsigned seed) {
  answer = example_csv(rows, tempco_per_K, seed);
  return answer.c_str();
}

/// What is in a recording. @return JSON: `text` for a person and `mapping`, the lines of a mapping file, or `error`
const char* thermopower_columns(const char* path) {
  nlohmann::ordered_json result;
  try {
    const io::LogContents contents = io::list_log(path);
    result = {{"text", io::columns_text(contents)}, {"mapping", io::column_map_text(contents.columns)}};
  } catch (const std::exception& problem) {
    result = {{"error", problem.what()}};
  }
  answer = result.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return answer.c_str();
}

/// @param training, held_out  paths, one a line; without held-out ones the last 30 % of each recording are
/// @param mapping  lines of a mapping file, and of options of the program; may be empty
/// @return JSON: `verdict`, `rows`, `seconds`, `summary`, `report`, `curves` and `html`, or `error`
const char* thermopower_diagnose(const char* model, const char* training, const char* held_out,
                                 const char* mapping) {
  nlohmann::ordered_json result;
  try {
    result = diagnosed(model, lines(training), lines(held_out), mapping);
  } catch (const std::exception& problem) {
    result = {{"error", problem.what()}};
  }
  answer = result.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return answer.c_str();
}

}  // extern "C"
