// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/header_export.hpp>

#include "expression_text.hpp"

#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/thesis_current.hpp>

#include <thermopower/plant/derivative.hpp>
#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/film.hpp>
#include <thermopower/plant/own_plant.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/terms.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace thermopower::io {
namespace {

using plant::Expression;
using plant::GivenExpression;
using plant::NotTraceable;
using plant::Trace;
using Hooks = plant::detail::Hooks<Expression>;

std::string literal(double value) { return number_text(value, Spelling::firmware); }

// Names of files and effects end up in comments and identifiers: neither may break the code.
std::string one_line(const std::string& text) {
  std::string out;
  for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == '\\' ? ' ' : c;
  return out;
}

std::string identifier(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0) out.insert(0, "p_");
  return out;
}

/// An effect of the model that can write itself.
struct Written {
  const CatalogueEntry* entry;
  std::vector<double> values;          ///< of its parameters
  std::vector<Expression> parameters;  ///< the same as constants of a trace

  template <class Terms>
  void act(Terms& terms) const {
    entry->of<Expression>().call(parameters.data(), terms);
  }
};

/// What the electrical effects make of the circuit.
struct Circuit {
  Expression open_V;        ///< at the motor's terminals without current
  Expression outside_ohm;   ///< all that drops volts outside of the body
  Expression series_ohm;    ///< the part of it that is in the motor's circuit
  Expression tempco_per_K;  ///< of the winding
  Expression source_ohm;    ///< between supply and bridge
  Expression supply_V;      ///< open-circuit supply
  Expression root_duty;     ///< V_rms per volt of the supply
};

/// What the thermal effects make of heat and loss.
struct Heat {
  Expression heat_W, conductance_factor, extra_loss_W;
};

/// Torques on the axis.
struct Torques {
  Expression delivered_Nm, load_Nm, friction_Nm;
  std::vector<Expression> own_slopes;  ///< of the effects' own states, per second
};

class Writer {
public:
  Writer(const Model& model, const std::string& origin, const Catalogue& catalogue)
      : m_(model), origin_(origin), ohmic_(std::get_if<OhmicCurrentModel>(&model.current)) {
    if (m_.own) return;  // writes itself, its effects included
    for (const CatalogueEntry& entry : catalogue.entries()) {
      const auto found = model.effects.find(entry.info.id);
      if (found != model.effects.end()) take(entry, found->second);
    }
    for (const auto& [id, parameters] : model.effects)
      if (catalogue.find(id) == nullptr) leave(id, "the catalogue does not know its equation");
  }

  MotorModelHeader write() {
    body_ = "";
    tables();
    current();
    thermal();
    axis();
    leftovers();
    MotorModelHeader header;
    header.text = "// Written by thermopower-gap: " + one_line(origin_) + "\n";
    for (const std::string& one : left_out_) header.text += "// Left out: " + one_line(one) + "\n";
    header.text += "#pragma once\n\n";
    if (m_.has_current() || m_.has_thermal()) header.text += "#include <thermopower/thermopower.hpp>\n";
    else if (has_curve()) header.text += "#include <thermopower/actuator/curve.hpp>\n";
    header.text += "#include <math.h>\n\nnamespace motor_model {\n\n" + before_ + "/// " +
                   one_line(m_.name.empty() ? "The motor" : m_.name) +
                   ", with what the diagnosis found.\nstruct Motor {\n" + body_ +
                   "};\n\n}  // namespace motor_model\n";
    header.left_out = left_out_;
    return header;
  }

private:
  // --- which effects write themselves

  void take(const CatalogueEntry& entry, const EffectParameters& given) {
    Written one{&entry, {}, {}};
    for (const Parameter& parameter : entry.info.parameters) {
      const auto value = given.find(parameter.name);
      one.values.push_back(value != given.end() ? value->second : parameter.standard.value_or(0.0));
    }
    one.parameters.assign(one.values.begin(), one.values.end());
    try {
      probe(one);
      written_.push_back(std::move(one));
    } catch (const NotTraceable& why) {
      leave(entry.info.id, why.what());
    }
  }

  /// Lets an effect write itself alone. @throws NotTraceable where it cannot
  void probe(const Written& one) const {
    const std::vector<Written> alone{one};
    Trace trace;
    trace.every_branch([&] { return std::vector<Expression>{circuit(trace, alone).open_V}; });
    trace.every_branch([&] { return std::vector<Expression>{air(trace, alone)}; });
    trace.every_branch([&] { return std::vector<Expression>{heat(trace, alone, {}).heat_W}; });
    trace.every_branch(
        [&] { return std::vector<Expression>{readings(trace, alone, trace.symbol("x")).motor_C}; });
    trace.every_branch([&] { return std::vector<Expression>{drive(trace, alone)}; });
    torques_in_every_branch(trace, alone);
    trace.every_branch(
        [&] { return std::vector<Expression>{axis_readings(trace, alone, trace.symbol("x")).angle_deg}; });
    // Readings are undone by two evaluations.
    const auto shown_deg = [&](double angle_deg) {
      plant::AxisReadings<double> read{0.0, angle_deg, 0.0};
      one.entry->of<double>().call(one.values.data(), read);
      return read.angle_deg;
    };
    const double at_0 = shown_deg(0.0), per_deg = shown_deg(1.0) - at_0;
    for (const double angle_deg : {-77.0, 31.0, 190.0})
      if (std::abs(shown_deg(angle_deg) - at_0 - per_deg * angle_deg) >
          1e-9 * (1.0 + std::abs(per_deg * angle_deg)))
        throw NotTraceable("what it does to the angle's reading cannot be undone in closed form");
  }

  void leave(const std::string& id, const std::string& why) {
    unwritten_.insert(id);
    left_out_.push_back(id + ": " + why + "; its parameters are constants of the header");
  }
  void leave_part(const std::string& id, const std::string& what) { left_out_.push_back(id + ": " + what); }

  // --- the plant's equations, as the effects change them

  static Circuit circuit_terms(Trace& trace, const std::vector<Written>& effects,
                               const OhmicCurrentModel* ohmic) {
    plant::ElectricalTerms<Expression> terms;
    terms.t_s = GivenExpression(trace.symbol("t_s"));
    terms.rate_dps = GivenExpression(trace.symbol("rate_rad_s") * plant::deg_per_rad);
    terms.winding_C = trace.symbol("winding_C");
    terms.charge_Ah = trace.symbol("charge_Ah");
    terms.supply_V = trace.symbol("supply_V");
    terms.duty = trace.symbol("duty");
    terms.source_ohm = terms.series_ohm = terms.counter_V = 0.0;
    terms.tempco_per_K = ohmic != nullptr ? ohmic->tempco_per_K : 0.0;
    for (const Written& one : effects) one.act(terms);
    Circuit result;
    result.root_duty = sqrt(terms.duty);
    result.open_V = terms.supply_V * result.root_duty - terms.counter_V;
    result.outside_ohm = terms.series_ohm + terms.source_ohm * terms.duty;
    result.series_ohm = terms.series_ohm;
    result.source_ohm = terms.source_ohm;
    result.tempco_per_K = terms.tempco_per_K;
    result.supply_V = terms.supply_V;
    return result;
  }
  Circuit circuit(Trace& trace, const std::vector<Written>& effects) const {
    const auto all = trace.every_branch([&] {
      const Circuit one = circuit_terms(trace, effects, ohmic_);
      return std::vector<Expression>{one.open_V,     one.outside_ohm, one.series_ohm, one.tempco_per_K,
                                     one.source_ohm, one.supply_V,    one.root_duty};
    });
    return {all[0], all[1], all[2], all[3], all[4], all[5], all[6]};
  }

  static Expression air(Trace& trace, const std::vector<Written>& effects) {
    plant::AirTerms<Expression> terms;
    terms.t_s = GivenExpression(trace.symbol("t_s"));
    terms.measured_ambient_C = GivenExpression(trace.symbol("measured_C"));
    terms.ambient_C = trace.symbol("measured_C");
    for (const Written& one : effects) one.act(terms);
    return terms.ambient_C;
  }

  /// @param from  what heat, factor and extra loss start from
  Heat heat(Trace& trace, const std::vector<Written>& effects, const Heat& from) const {
    plant::ThermalTerms<Expression> terms;
    terms.t_s = GivenExpression(trace.symbol("t_s"));
    terms.airspeed_mps = GivenExpression(trace.symbol("airspeed_mps"));
    terms.neighbour_C = GivenExpression(trace.symbol("neighbour_C"));
    terms.rate_dps = GivenExpression(trace.symbol("rate_rad_s") * plant::deg_per_rad);
    terms.measured_ambient_C = GivenExpression(trace.symbol("air_C"));
    terms.winding_C = trace.symbol("motor_C");
    terms.surface_C = trace.symbol(two_nodes_ ? "surface_C" : "motor_C");
    terms.ambient_C = trace.symbol("air_C");
    terms.current_A = trace.symbol("current_A");
    terms.supply_V = trace.symbol("supply_V");
    terms.v_rms_V = trace.symbol("winding_V");
    terms.heat_W = from.heat_W;
    terms.conductance_factor = from.conductance_factor;
    terms.extra_loss_W = from.extra_loss_W;
    for (const Written& one : effects) one.act(terms);
    return {terms.heat_W, terms.conductance_factor, terms.extra_loss_W};
  }
  Heat heat_in_every_branch(Trace& trace, const std::vector<Written>& effects, const Heat& from) const {
    const auto all = trace.every_branch([&] {
      const Heat one = heat(trace, effects, from);
      return std::vector<Expression>{one.heat_W, one.conductance_factor, one.extra_loss_W};
    });
    return {all[0], all[1], all[2]};
  }

  static plant::BenchReadings<Expression> readings(Trace& trace, const std::vector<Written>& effects,
                                                   const Expression& truth) {
    plant::BenchReadings<Expression> read;
    read.t_s = GivenExpression(trace.symbol("t_s"));
    read.measured_ambient_C = GivenExpression(trace.symbol("measured_air_C"));
    read.current_A = read.motor_C = truth;
    for (const Written& one : effects) one.act(read);
    return read;
  }

  static plant::AxisReadings<Expression> axis_readings(Trace& trace, const std::vector<Written>& effects,
                                                       const Expression& truth) {
    plant::AxisReadings<Expression> read;
    read.t_s = GivenExpression(trace.symbol("t_s"));
    read.angle_deg = read.rate_dps = truth;
    for (const Written& one : effects) one.act(read);
    return read;
  }

  Expression drive(Trace& trace, const std::vector<Written>& effects) const {
    plant::DriveTerms<Expression> terms;
    terms.t_s = GivenExpression(trace.symbol("t_s"));
    terms.motor_C = GivenExpression(trace.symbol("motor_C"));
    const bool voltage_driven = m_.axis && m_.axis->voltage_driven();
    terms.drive_A = voltage_driven ? trace.symbol("command_V") / Expression(m_.axis->resistance_ohm)
                                   : trace.symbol("command_A");
    terms.torque_constant_Nm_per_A = m_.axis ? m_.axis->torque_constant_Nm_per_A : 1.0;
    for (const Written& one : effects) one.act(terms);
    if (voltage_driven)  // less what the motor's own voltage holds back
      terms.drive_A -=
          terms.torque_constant_Nm_per_A * trace.symbol("rate_rad_per_s") / m_.axis->resistance_ohm;
    return terms.torque_constant_Nm_per_A * terms.drive_A;
  }

  static Torques torques(Trace& trace, const std::vector<Written>& effects, double viscous_Nms_per_rad) {
    const Expression angle = trace.symbol("angle_rad"), rate = trace.symbol("rate_rad_per_s"),
                     drive = trace.symbol("drive_torque_Nm");
    const GivenExpression t_s(trace.symbol("t_s")), motor_C(trace.symbol("motor_C"));
    std::vector<plant::OwnState<Expression>> own;
    std::vector<std::size_t> first;
    for (const Written& one : effects) {
      first.push_back(own.size());
      for (const plant::HiddenState& state : one.entry->info.states)
        own.push_back({trace.symbol(state.name), 0.0, 0.0});
    }
    plant::AxisTerms<Expression> terms{t_s, angle, rate, drive, 0.0, drive};
    for (std::size_t i = 0; i < effects.size(); ++i) {
      terms.own = own.data() + first[i];
      effects[i].act(terms);
    }
    const Expression load = terms.load_Nm, delivered = terms.delivered_Nm;
    plant::FrictionTerms<Expression> dry(t_s, motor_C, angle, rate, delivered, load);
    for (std::size_t i = 0; i < effects.size(); ++i) {
      dry.own = own.data() + first[i];
      effects[i].act(dry);
    }
    const Expression size = dry.forward_Nm.is_constant() && dry.backward_Nm.is_constant() &&
                                    dry.forward_Nm.constant_value() == dry.backward_Nm.constant_value()
                                ? dry.forward_Nm
                                : Trace::choice(rate < 0.0, dry.backward_Nm, dry.forward_Nm);
    const bool none =
        dry.transition_rad_per_s.is_constant() && !(dry.transition_rad_per_s.constant_value() > 0.0);
    // What friction there is besides the header's viscous one; a factor works on that one, too.
    Expression friction = dry.torque_Nm * dry.factor + viscous_Nms_per_rad * (dry.factor - 1.0) * rate;
    const bool steep = dry.tail.is_constant() && dry.tail.constant_value() == 0.0;
    const Expression transitions = none ? Expression(0.0) : rate / dry.transition_rad_per_s;
    if (!none)
      friction += size * dry.factor * (steep ? tanh(transitions) : plant::film_share(transitions, dry.tail));
    Torques result{delivered, load, friction, {}};
    for (const plant::OwnState<Expression>& state : own)
      result.own_slopes.push_back(state.slope - state.per_s * state.value);
    return result;
  }
  Torques torques_in_every_branch(Trace& trace, const std::vector<Written>& effects) const {
    const double viscous = m_.axis ? m_.axis->viscous_Nms_per_rad : 0.0;
    auto all = trace.every_branch([&] {
      const Torques one = torques(trace, effects, viscous);
      std::vector<Expression> list{one.delivered_Nm, one.load_Nm, one.friction_Nm};
      list.insert(list.end(), one.own_slopes.begin(), one.own_slopes.end());
      return list;
    });
    return {all[0], all[1], all[2], std::vector<Expression>(all.begin() + 3, all.end())};
  }

  // --- code

  /// A function of floats whose body returns a value. Arguments in `always` are taken whether used or not; t_s
  /// is taken besides where the value depends on the time.
  std::string function(const std::string& comment, const std::string& name,
                       const std::vector<std::string>& always, const Expression& value,
                       const std::string& margin = "  ", const std::string& head = "static float ",
                       const std::string& tail = "") const {
    const std::set<std::string> used = symbols_of({value});
    std::string arguments, unused;
    for (const std::string& one : always) {
      arguments += (arguments.empty() ? "float " : ", float ") + one;
      if (used.count(one) == 0) unused += margin + "  (void)" + one + ";\n";
    }
    if (used.count("t_s") != 0 && std::find(always.begin(), always.end(), "t_s") == always.end())
      arguments += std::string(arguments.empty() ? "" : ", ") + "float t_s";
    return commented(comment, margin) + margin + head + name + "(" + arguments + ")" + tail + " {\n" +
           unused + code_text({{"return", value}}, static_cast<int>(margin.size()) + 2) + margin + "}\n";
  }

  static std::string commented(const std::string& text, const std::string& margin) {
    std::string out, line;
    for (const char c : text + "\n") {
      if (c != '\n') {
        line += c;
        continue;
      }
      out += margin + "/// " + one_line(line) + "\n";
      line.clear();
    }
    return out;
  }

  /// The effects among `hooked` that have one of the hooks, a line each.
  template <class Hooked>
  std::string with(Hooked&& hooked) const {
    std::string out;
    for (const Written& one : written_)
      if (hooked(one.entry->hooks))
        out += "\nWith " + one.entry->info.id + ": " + one.entry->info.equation + ".";
    return out;
  }

  bool has_curve() const {
    return std::any_of(written_.begin(), written_.end(),
                       [](const Written& one) { return one.entry->info.curve.has_value(); });
  }

  /// The values of curves at their knots, in program memory.
  void tables() {
    for (const Written& one : written_) {
      if (!one.entry->info.curve) continue;
      const auto name = [&](int i) {
        return one.entry->info.parameters[static_cast<std::size_t>(i)].name + " " +
               number_text(one.values[static_cast<std::size_t>(i)], Spelling::formula);
      };
      before_ += commented(one.entry->info.id + " at evenly spaced knots, " +
                               one.entry->info.parameters.back().unit + ": " + name(0) + ", " + name(1) + ".",
                           "");
      before_ += "static const float " + curve_table_name(one.entry->info.id) + "[] thermopower_flash = {";
      for (std::size_t i = plant::curve_support_count; i < one.values.size(); ++i)
        before_ += (i > plant::curve_support_count ? ", " : "") + literal(one.values[i]);
      before_ += "};\n\n";
    }
  }

  void constant(const std::string& comment, const std::string& name, double value) {
    body_ += "  /// " + comment + "\n  static float " + name + "() { return " + literal(value) + "; }\n";
  }

  void current() {
    if (!m_.has_current()) return;
    Trace trace;
    const Circuit at = circuit(trace, written_);
    // A constant resistance in series and R(T) are together a resistance with a smaller temperature
    // coefficient, exactly; what changes is left to v_rms_V().
    const bool fold = ohmic_ != nullptr && at.series_ohm.is_constant() && at.tempco_per_K.is_constant();
    const double series = fold ? at.series_ohm.constant_value() : 0.0;
    folded_ohm_ = series;
    Expression law_ohm = 0.0, winding_ohm = 0.0;
    if (ohmic_ != nullptr) {
      const double total = ohmic_->resistance_ohm + series;
      const double slope = fold ? at.tempco_per_K.constant_value() : ohmic_->tempco_per_K;
      const double tempco = slope * ohmic_->resistance_ohm / total;
      body_ +=
          "  typedef thermopower::CurrentModel<thermopower::OhmicCurrent<float> > Current;  ///< Current law.\n";
      body_ += "  /// Constants for `Current`" +
               std::string(series > 0.0 ? ", the resistance in series included.\n" : ".\n");
      body_ += "  static Current::Config current() {\n    Current::Config law = {" + literal(total) + ", " +
               literal(tempco) + ", " + literal(ohmic_->reference_C) + "};\n    return law;\n  }\n";
      law_ohm = OhmicCurrent<Expression>{total, tempco, ohmic_->reference_C}.resistance_at(
          trace.symbol("winding_C"));
      winding_ohm = OhmicCurrent<Expression>{ohmic_->resistance_ohm, at.tempco_per_K, ohmic_->reference_C}
                        .resistance_at(trace.symbol("winding_C"));
      if (!at.tempco_per_K.is_constant())
        left_out_.push_back(
            "heat_W() takes the winding's temperature coefficient as it is without its changes");
    } else {
      const auto& thesis = std::get<ThesisCurrentModel>(m_.current);
      body_ +=
          "  typedef thermopower::CurrentModel<thermopower::ThesisCurrent<float> > Current;  ///< Current law.\n";
      body_ +=
          "  /// Constants for `Current`.\n  static Current::Config current() {\n    return "
          "thermopower::ThesisCurrent<float>::from_milliampere(" +
          literal(thesis.slope_V2_mA_per_K) + ", " + literal(thesis.slope_V1_mA_per_K) + ", " +
          literal(thesis.slope_V0_mA_per_K) + ", " + literal(thesis.base_mA) + ", " +
          literal(thesis.exponent) + ", " + literal(thesis.minimum_V_rms) + ");\n  }\n";
    }
    const std::vector<std::string> arguments = {"duty", "supply_V", "winding_C", "charge_Ah", "rate_rad_s"};
    const auto electrical = with([](const HookSet& hooks) { return hooks.electrical; });
    body_ += function(
        "Voltage for the current law and the heating, V, >= 0: given to the law it yields the current that flows."
        "\n@param duty        commanded, 0 .. 1\n@param supply_V    of the supply, as measured or nominal"
        "\n@param charge_Ah   drawn from the supply since it was full\n@param rate_rad_s  of the motor" +
            electrical,
        "v_rms_V", arguments, law_voltage(trace, at, law_ohm, winding_ohm, fold));
    body_ += function("Supply at the bridge under load, V, for heat_W()." + electrical, "bridge_V",
                      {"duty", "supply_V", "current_A", "winding_C", "charge_Ah", "rate_rad_s"},
                      at.supply_V - at.source_ohm * trace.symbol("current_A") * at.root_duty);
    constant(
        "Resistance outside of the motor's body that `Current` includes: it drops volts and heats nothing, ohm.",
        "series_ohm", series);
    undo("true_current_A", "The true current behind a sensor's reading, A.",
         [](const plant::BenchReadings<Expression>& read) { return read.current_A; }, {"reading_A"});
  }

  /// The voltage that makes the current law of the header yield the current of the circuit.
  Expression law_voltage(Trace& trace, const Circuit& at, const Expression& law_ohm,
                         const Expression& winding_ohm, bool folded) const {
    const Expression open_V = plant::at_least(at.open_V, 0.0);
    if (ohmic_ != nullptr) {
      const bool all_folded = folded && at.source_ohm.is_constant() && at.source_ohm.constant_value() == 0.0;
      return all_folded ? open_V : open_V * law_ohm / (winding_ohm + at.outside_ohm);
    }
    if (at.outside_ohm.is_constant() && at.outside_ohm.constant_value() == 0.0) return open_V;
    const auto& thesis = std::get<ThesisCurrentModel>(m_.current);
    const auto law = ThesisCurrent<Expression>::from_milliampere(
        thesis.slope_V2_mA_per_K, thesis.slope_V1_mA_per_K, thesis.slope_V0_mA_per_K, thesis.base_mA,
        thesis.exponent, thesis.minimum_V_rms);
    // As the simulation does: the volts outside follow the current, which follows the volts left.
    Expression voltage = open_V;
    for (int i = 0; i < 4; ++i)
      voltage = plant::at_least(
          Expression(at.open_V - at.outside_ohm * law.current_A(voltage, trace.symbol("winding_C"))), 0.0);
    return voltage;
  }

  /// A function that undoes what effects do to a reading. Readings are affine in the truth, as the simulation's
  /// starts take them to be: two evaluations invert them.
  template <class Pick>
  void undo(const std::string& name, const std::string& comment, Pick&& pick,
            std::vector<std::string> arguments) {
    Trace trace;
    const auto at = [&](const Expression& truth) {
      return trace.every_branch(
          [&] { return std::vector<Expression>{pick(readings(trace, written_, truth))}; })[0];
    };
    const Expression truth = trace.symbol("truth");
    const Expression reading = at(truth);
    if (!reading.is_constant() && reading.node() == truth.node()) return;
    const Expression at_0 = at(0.0), at_1 = at(1.0);
    body_ += function(comment + with([](const HookSet& hooks) { return hooks.bench_readings; }), name,
                      arguments, (trace.symbol(arguments.front()) - at_0) / (at_1 - at_0));
  }

  void thermal() {
    const auto* lumped = std::get_if<LumpedThermalModel>(&m_.thermal);
    const auto* thesis = std::get_if<ThesisThermalModel>(&m_.thermal);
    if (lumped == nullptr && thesis == nullptr) return;
    plant::ThermalStructure<double> shape{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (const Written& one : written_) one.entry->of<double>().call(one.values.data(), shape);
    // What stands behind the surface or around the body is no part of firmware's types.
    for (const Written& one : written_) {
      plant::ThermalStructure<double> alone{1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      one.entry->of<double>().call(one.values.data(), alone);
      if (alone.has_further_nodes())
        leave(one.entry->info.id, "`Thermal` has no nodes but winding and surface");
    }
    two_nodes_ = shape.two_nodes;
    heating_exchanged_ = shape.heating_exchanged;
    if (shape.two_nodes && lumped == nullptr) {
      for (const Written& one : written_)
        if (one.entry->hooks.thermal_structure)
          leave_part(one.entry->info.id,
                     "the thesis's law has one node in firmware; `Thermal` is without a second");
      two_nodes_ = false;
    }
    Trace trace;
    const Heat nothing{trace.symbol("winding_V") * trace.symbol("current_A"), 1.0, 0.0};
    // What depends on surface and air alone belongs to the cooling law, the rest to the heat.
    static const std::set<std::string> of_cooling = {"motor_C", "surface_C", "air_C", "airspeed_mps"};
    std::vector<Written> cooling, other;
    for (const Written& one : written_) {
      if (!one.entry->hooks.thermal) continue;
      const Heat alone = heat_in_every_branch(trace, {one}, nothing);
      bool is_cooling = true;
      for (const std::string& name : symbols_of({alone.conductance_factor, alone.extra_loss_W}))
        is_cooling = is_cooling && of_cooling.count(name) != 0;
      (is_cooling ? cooling : other).push_back(one);
    }
    const Heat cooled = heat_in_every_branch(trace, cooling, nothing);
    Heat after = cooled;
    after.extra_loss_W = 0.0;
    const Heat all = heat_in_every_branch(trace, other, after);
    const Expression surface_C = trace.symbol(two_nodes_ ? "surface_C" : "motor_C"),
                     air_C = trace.symbol("air_C");
    const double base = lumped != nullptr ? lumped->conductance_W_per_K : thesis->cooling_per_min / 60.0;
    if (two_nodes_) two_nodes(*lumped, shape, cooled, cooling);
    else one_node(trace, lumped, thesis, cooled, base);
    // A loss that the cooling law cannot know of is heat taken out of the motor.
    Expression heat_W = all.heat_W - all.extra_loss_W;
    const Expression more = all.conductance_factor - cooled.conductance_factor;
    if (!(more.is_constant() && more.constant_value() == 0.0)) {
      if (lumped != nullptr) heat_W -= base * more * (surface_C - air_C);
      else
        for (const Written& one : other)
          leave_part(one.entry->info.id, "what it does to the thesis's cooling rate is not in `Thermal`");
    }
    if (two_nodes_ && symbols_of({heat_W}).count("surface_C") != 0) {
      for (const Written& one : other)
        if (changes_loss(one))
          leave_part(one.entry->info.id,
                     "it acts on the surface of two nodes; heat_W() takes the winding's temperature for it");
    }
    std::string code = function(
        "Heat into the motor for `Thermal::step`, W: what the winding turns into heat, and what was found besides."
        "\n@param v_rms      from v_rms_V()\n@param supply_V   at the bridge, from bridge_V()\n@param air_C      from air_C()" +
            with([](const HookSet& hooks) { return hooks.thermal; }),
        "heat_W", {"v_rms", "current_A", "supply_V", "motor_C", "neighbour_C", "rate_rad_s", "air_C"},
        substituted(trace, heat_W));
    body_ += code;
    air();
    undo("true_motor_C", "The true temperature behind a thermometer's reading, degC.",
         [](const plant::BenchReadings<Expression>& read) { return read.motor_C; },
         {"reading_C", "measured_air_C"});
    if (shape.lagged)
      constant("Time constant of the thermometer, s: its reading follows the motor that much later.",
               "thermometer_lag_s", shape.thermometer_lag_s);
  }

  /// The winding's voltage as the header's functions know it, and the surface as its only temperature.
  Expression substituted(Trace& trace, const Expression& value) const {
    Expression winding_V = trace.symbol("v_rms");
    if (folded_ohm_ != 0.0) winding_V -= folded_ohm_ * trace.symbol("current_A");
    return trace.replaced(trace.replaced(value, trace.symbol("winding_V"), winding_V),
                          trace.symbol("surface_C"), trace.symbol("motor_C"));
  }

  void air() {
    Trace trace;
    const Expression air_C =
        trace.every_branch([&] { return std::vector<Expression>{air(trace, written_)}; })[0];
    body_ += function("Temperature of the air that the motor feels, degC, from what its sensor says." +
                          with([](const HookSet& hooks) { return hooks.air; }),
                      "air_C", {"measured_C"}, air_C);
  }

  /// Whether it has a part in the loss to the air.
  bool changes_loss(const Written& one) const {
    Trace trace;
    const Heat alone = heat_in_every_branch(trace, {one}, {0.0, 1.0, 0.0});
    return !alone.conductance_factor.is_constant() || !alone.extra_loss_W.is_constant() ||
           alone.extra_loss_W.constant_value() != 0.0;
  }

  void two_nodes(const LumpedThermalModel& lumped, const plant::ThermalStructure<double>& shape,
                 const Heat& cooled, const std::vector<Written>& cooling) {
    const bool newton = cooled.conductance_factor.is_constant() && cooled.extra_loss_W.is_constant() &&
                        cooled.extra_loss_W.constant_value() == 0.0;
    for (const Written& one : cooling) {
      if (newton || !changes_loss(one)) continue;
      leave_part(
          one.entry->info.id,
          "what it adds to the loss of two nodes is not in `Thermal`, whose surface cools by Newton's law; "
          "its parameters are constants of the header");
      unwritten_.insert(one.entry->info.id);
    }
    const double factor = newton ? cooled.conductance_factor.constant_value() : 1.0;
    const double share = shape.winding_share;
    body_ +=
        "  typedef thermopower::TwoNodeThermalModel<float> Thermal;  ///< Thermal model: winding and body.\n"
        "  /// Constants for `Thermal`.\n  static Thermal::Config thermal() {\n    Thermal::Config config = {" +
        literal(share * lumped.heat_capacity_J_per_K) + ", " +
        literal((1.0 - share) * lumped.heat_capacity_J_per_K) + ", " + literal(shape.coupling_W_per_K) +
        ", {" + literal(factor * lumped.conductance_W_per_K) + "}};\n    return config;\n  }\n";
  }

  void one_node(Trace& trace, const LumpedThermalModel* lumped, const ThesisThermalModel* thesis,
                const Heat& cooled, double base) {
    const bool linear = cooled.conductance_factor.is_constant() && cooled.extra_loss_W.is_constant() &&
                        cooled.extra_loss_W.constant_value() == 0.0;
    std::string type =
        lumped != nullptr ? "thermopower::NewtonCooling<float>" : "thermopower::RateCooling<float>";
    std::string value =
        "{" + literal(linear ? base * cooled.conductance_factor.constant_value() : base) + "}";
    if (!linear) {
      type = "Cooling";
      value = "Cooling()";
      cooling_law(trace, cooled, base, lumped != nullptr);
    }
    std::string heating = "thermopower::HeatCapacityHeating<float>", of_heating;
    if (lumped != nullptr) {
      of_heating = "{" + literal(lumped->heat_capacity_J_per_K) + "}";
    } else {
      heating = "thermopower::ThesisHeating<float>";
      double slope_V0 = thesis->rinv_slope_V0, offset_V1 = thesis->rinv_offset_V1;
      if (heating_exchanged_) std::swap(slope_V0, offset_V1);
      of_heating = "thermopower::ThesisHeating<float>::per_minute(" + literal(thesis->rinv_slope_V1) + ", " +
                   literal(slope_V0) + ", " + literal(offset_V1) + ", " + literal(thesis->rinv_offset_V0) +
                   ", " + literal(thesis->minimum_V_rms) + ")";
    }
    body_ +=
        "  typedef thermopower::ThermalModel<" + heating + ", " + type +
        ", thermopower::LinearizedStep> Thermal;  ///< Thermal model.\n"
        "  /// Constants for `Thermal`.\n  static Thermal::Config thermal() {\n    Thermal::Config config = {" +
        of_heating + ", " + value + "};\n    return config;\n  }\n";
  }

  /// A policy as ThermalModel takes it, with the loss that the effects make of Newton's law.
  void cooling_law(Trace& trace, const Heat& cooled, double base, bool in_watts) {
    const Expression motor_C = trace.symbol("motor_C"), rise = trace.symbol("rise_K_per_J");
    const Expression natural = base * cooled.conductance_factor * (motor_C - trace.symbol("air_C"));
    const Expression rate =
        in_watts ? rise * (natural + cooled.extra_loss_W) : natural + rise * cooled.extra_loss_W;
    const std::string margin = "  ", tail = " const noexcept";
    const auto method = [&](const std::string& comment, const std::string& name, const Expression& value) {
      const std::set<std::string> used = symbols_of({value});
      std::string out =
          margin + "/// " + comment + "\n" + margin + "float " + name +
          "(float motor_C, const thermopower::Surroundings<float>& around, float rise_K_per_J)" + tail +
          " {\n";
      for (const char* one : {"motor_C", "rise_K_per_J"})
        if (used.count(one) == 0) out += margin + "  (void)" + one + ";\n";
      if (used.count("air_C") != 0) out += margin + "  const float air_C = around.air_C;\n";
      if (used.count("airspeed_mps") != 0)
        out += margin + "  const float airspeed_mps = around.airspeed_mps;\n";
      if (used.count("air_C") + used.count("airspeed_mps") == 0) out += margin + "  (void)around;\n";
      return out + code_text({{"return", value}}, 4) + margin + "}\n";
    };
    before_ +=
        commented("How the heat leaves." + with([](const HookSet& hooks) { return hooks.thermal; }), "") +
        "struct Cooling {\n  typedef float Scalar;  ///< What it computes in.\n"
        "  static constexpr bool is_linear() { return false; }  ///< Not proportional to the rise.\n"
        "  static constexpr bool is_in_watts() { return " +
        std::string(in_watts ? "true" : "false") + "; }  ///< As `ThermalModel` asks.\n" +
        method("Cooling rate, K/s.", "rate_K_per_s", rate) +
        method("d rate / dT, 1/s.", "slope_per_s", derivative(rate, motor_C)) +
        "  /// Its constants are part of its code.\n"
        "  thermopower::ConfigError validate() const noexcept { return thermopower::ConfigError::none; }\n"
        "};\n\n";
  }

  void axis() {
    if (!m_.axis) return;
    constant("Inertia of the axis, kg m^2.", "inertia_kgm2", m_.axis->inertia_kgm2);
    constant("Viscous friction, N m s/rad.", "viscous_Nms_per_rad", m_.axis->viscous_Nms_per_rad);
    constant("Torque per ampere, N m/A.", "torque_constant_Nm_per_A", m_.axis->torque_constant_Nm_per_A);
    if (m_.axis->voltage_driven())
      constant("Resistance of the motor, ohm.", "resistance_ohm", m_.axis->resistance_ohm);
    for (const NamedConstant& one : m_.constants())
      if (one.block == "servo")
        constant("Of the servo, in the unit its name ends in.", "servo_" + one.name, one.value);
    plant::AxisStructure<double> shape{0.0, 0.0, 0.0, 0.0, 0.0, false, false, false, 0.0, false};
    for (const Written& one : written_) one.entry->of<double>().call(one.values.data(), shape);
    if (shape.delayed) constant("From command to torque, s.", "delay_s", shape.delay_s);
    if (shape.target_delayed)
      constant("From a target to the servo that takes it, s.", "target_delay_s", shape.target_delay_s);
    if (shape.compliant) {
      constant("Share of the inertia behind a spring.", "far_share", shape.far_share);
      constant("Natural frequency of the two inertias against each other, rad/s.", "spring_rad_per_s",
               shape.spring_rad_per_s);
      constant("Damping ratio of that motion.", "spring_damping", shape.spring_damping);
      if (shape.gapped) constant("Free play of the spring, from end to end, rad.", "gap_rad", shape.gap_rad);
    }
    Trace trace;
    const Expression drive_Nm =
        trace.every_branch([&] { return std::vector<Expression>{drive(trace, written_)}; })[0];
    body_ += function(
        "Torque of the drive, N m." + with([](const HookSet& hooks) { return hooks.drive; }), "drive_Nm",
        m_.axis->voltage_driven() ? std::vector<std::string>{"command_V", "motor_C", "rate_rad_per_s"}
                                  : std::vector<std::string>{"command_A", "motor_C"},
        drive_Nm);
    const Torques all = torques_in_every_branch(trace, written_);
    std::vector<std::string> load_takes = {"angle_rad", "rate_rad_per_s", "drive_torque_Nm"},
                             friction_takes = load_takes;
    friction_takes.emplace_back("motor_C");
    for (const Written& one : written_)
      for (const plant::HiddenState& state : one.entry->info.states) {
        load_takes.push_back(state.name);
        friction_takes.push_back(state.name);
      }
    // A drive that something comes between is told from the torque that is asked of it.
    body_ += function(
        "What pulls besides drive and friction, N m, added to the drive's torque; and what does not arrive of that." +
            with([](const HookSet& hooks) { return hooks.axis; }),
        "load_Nm", load_takes, all.load_Nm + (all.delivered_Nm - trace.symbol("drive_torque_Nm")));
    body_ += function(
        "Friction besides the viscous one, N m, to be taken off the other torques: positive while the rate is." +
            with([](const HookSet& hooks) { return hooks.friction; }),
        "dry_friction_Nm", friction_takes, all.friction_Nm);
    std::size_t place = 0;
    for (const Written& one : written_)
      for (const plant::HiddenState& state : one.entry->info.states)
        body_ += function("How fast the state " + state.name + " moves that " + one.entry->info.id +
                              " brings, " + state.unit + "/s. It starts at 0, or where this is 0.",
                          state.name + "_per_s", friction_takes, all.own_slopes[place++]);
    undo_axis(
        "true_angle_deg", "The true angle behind a reading, deg.",
        [](const plant::AxisReadings<Expression>& read) { return read.angle_deg; }, "reading_deg");
    undo_axis(
        "true_rate_dps", "The true rate behind a reading, deg/s.",
        [](const plant::AxisReadings<Expression>& read) { return read.rate_dps; }, "reading_dps");
  }

  template <class Pick>
  void undo_axis(const std::string& name, const std::string& comment, Pick&& pick,
                 const std::string& argument) {
    Trace trace;
    const auto at = [&](const Expression& truth) {
      return trace.every_branch(
          [&] { return std::vector<Expression>{pick(axis_readings(trace, written_, truth))}; })[0];
    };
    const Expression truth = trace.symbol("truth"), reading = at(truth);
    if (!reading.is_constant() && reading.node() == truth.node()) return;
    const Expression at_0 = at(0.0), at_1 = at(1.0);
    body_ += function(comment + with([](const HookSet& hooks) { return hooks.axis_readings; }), name,
                      {argument}, (trace.symbol(argument) - at_0) / (at_1 - at_0));
  }

  void own_plant() {
    const auto* plant = dynamic_cast<const plant::OwnPlant*>(m_.own->equations.get());
    Trace trace;
    try {
      std::vector<plant::WrittenEquation> equations;
      if (plant != nullptr) equations = plant->written(m_, trace);
      if (equations.empty()) throw NotTraceable("a simulator behind a function call shows no equation");
      for (const plant::WrittenEquation& one : equations)
        body_ += function(one_line(one.comment), identifier(one.name), one.arguments, one.value);
    } catch (const NotTraceable& why) {
      left_out_.push_back(m_.own->type + ": " + why.what() + "; its constants are constants of the header");
      for (const auto& effect : m_.effects) leave(effect.first, why.what());
    }
  }

  void leftovers() {
    if (m_.own)
      for (const PlantConstant& constant : m_.own->constants)
        body_ += "  /// Of " + one_line(constant.block) + ", " + one_line(constant.unit) +
                 ".\n  static float " + identifier(constant.name) + "() { return " + literal(constant.value) +
                 "; }\n";
    if (m_.own) own_plant();
    for (const std::string& id : unwritten_) {
      body_ += "  // Not in the functions above; its constants: " + one_line(id) + "\n";
      for (const auto& [name, value] : m_.effects.at(id))
        body_ += "  static float " + identifier(id) + "_" + identifier(name) + "() { return " +
                 literal(value) + "; }\n";
    }
  }

  const Model& m_;
  const std::string& origin_;
  const OhmicCurrentModel* ohmic_;
  std::vector<Written> written_;
  std::set<std::string> unwritten_;
  std::vector<std::string> left_out_;
  bool two_nodes_ = false;
  bool heating_exchanged_ = false;  ///< of the thesis's heating law
  double folded_ohm_ = 0.0;
  std::string before_, body_;
};

}  // namespace

MotorModelHeader motor_model_header(const Model& model, const std::string& origin,
                                    const Catalogue& catalogue) {
  return Writer(model, origin, catalogue).write();
}

}  // namespace thermopower::io
