// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "../gap/fixture.hpp"

#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/plant/effects/ambient_bias.hpp>
#include <thermopower/plant/effects/asymmetric_friction.hpp>
#include <thermopower/plant/effects/constant_torque.hpp>
#include <thermopower/plant/effects/drive_lag.hpp>
#include <thermopower/plant/effects/imbalance.hpp>
#include <thermopower/plant/effects/load_friction.hpp>
#include <thermopower/plant/effects/radiation.hpp>
#include <thermopower/plant/effects/stribeck_friction.hpp>
#include <thermopower/plant/effects/warm_friction.hpp>

#include <Eigen/QR>

#include <set>

using namespace engine_fixture;

namespace {

Eigen::VectorXd coordinates_of(const Trial& trial, const std::vector<Coordinate>& list) {
  Eigen::VectorXd at(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    double value = 0.0;
    for (const auto& parameter : trial.parameters)
      if (list[i].name == trial.id + "." + parameter.first)
        value = list[i].logarithmic ? std::log(parameter.second) : parameter.second;
    at[static_cast<Eigen::Index>(i)] = value;
  }
  return at;
}

Eigen::VectorXd residuals(const FitProblem& problem, const Explanation& explanation,
                          const std::vector<Coordinate>& list, const Eigen::VectorXd& at) {
  std::vector<double> all;
  problem.evaluate(explanation, list, at, problem.measured_starts(), false,
                   [&](std::size_t, const FitProblem::Residuals& one) {
                     for (double value : one.value) all.push_back(value);
                   });
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

}  // namespace

TEST_CASE("every effect of the catalogue is tried here") {
  std::set<std::string> tried;
  for (const Trial& trial : trials()) tried.insert(trial.id);
  for (const EffectInfo& info : standard_catalogue().list()) {
    INFO(info.id);
    CHECK(tried.count(info.id) == 1);
    CHECK_FALSE(info.equation.empty());
    CHECK_FALSE(info.prose.empty());
    CHECK_FALSE(info.experiment.empty());
  }
}

TEST_CASE(
    "an effect whose hooks are objects is added as one that is a type, and refused where it is not whole") {
  CatalogueEntry twin = *standard_catalogue().find("radiation");
  twin.info.id = "twin";
  Catalogue catalogue = standard_catalogue();
  catalogue.add(twin);
  REQUIRE(catalogue.find("twin") != nullptr);
  CHECK(catalogue.list().size() == standard_catalogue().list().size() + 1);
  CHECK_THROWS_AS(catalogue.add(twin), InvalidInput);  // the id is taken
  twin.info.id = "half";
  twin.dual = nullptr;
  CHECK_THROWS_AS(catalogue.add(twin), InvalidInput);
  twin.dual = standard_catalogue().find("radiation")->dual;
  twin.wide = nullptr;
  CHECK_THROWS_AS(catalogue.add(twin), InvalidInput);
  twin = *standard_catalogue().find("radiation");
  twin.info.id = "nowhere";
  twin.hooks = HookSet();
  CHECK_THROWS_AS(catalogue.add(twin), InvalidInput);
  CHECK(catalogue.list().size() == standard_catalogue().list().size() + 1);
}

TEST_CASE("derivatives by automatic differentiation agree with finite differences, for every effect") {
  for (const Trial& trial : trials()) {
    const Model model = baseline_of(trial);
    const std::vector<Inputs> inputs{prepare(model, recorded(trial, 11))};
    const Catalogue catalogue = catalogue_for(trial);
    FitProblem problem = problem_of(model, inputs);
    problem.catalogue = &catalogue;
    const Explanation explanation{{catalogue.find(trial.id)}, {}, true};
    const std::vector<Coordinate> list = coordinates(model, explanation, {});
    const Eigen::VectorXd at = coordinates_of(trial, list);
    Eigen::MatrixXd jacobian(residuals(problem, explanation, list, at).size(), at.size());
    Eigen::Index filled = 0;
    problem.evaluate(explanation, list, at, problem.measured_starts(), true,
                     [&](std::size_t, const FitProblem::Residuals& one) {
                       jacobian.middleRows(filled, one.value.size()) = one.jacobian.leftCols(at.size());
                       filled += one.value.size();
                     });
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      if (list[static_cast<std::size_t>(k)].still) continue;  // the range of a curve is no direction
      const double step = 1e-6 * std::max(std::abs(at[k]), 0.01);
      Eigen::VectorXd above = at, below = at;
      above[k] += step;
      below[k] -= step;
      const Eigen::VectorXd difference =
          (residuals(problem, explanation, list, above) - residuals(problem, explanation, list, below)) /
          (2.0 * step);
      INFO(trial.id << ", " << list[static_cast<std::size_t>(k)].name);
      // A finite difference across an event (a reversal, a switch of the step size) is off in single rows.
      CHECK((jacobian.col(k) - difference).norm() <= 0.01 * difference.norm() + 1e-6 * jacobian.norm());
    }
  }
}

TEST_CASE("every effect recovers its own parameters from its own simulation") {
  for (const Trial& trial : trials()) {
    const Model model = baseline_of(trial);
    const std::vector<Inputs> inputs{prepare(model, recorded(trial, 21))};
    const Catalogue catalogue = catalogue_for(trial);
    FitProblem problem = problem_of(model, inputs);
    problem.catalogue = &catalogue;
    const Attribution attribution(problem);
    INFO(trial.id);
    const Candidate empty = attribution.fit({}, {});
    Candidate fitted = attribution.fit({{catalogue.find(trial.id)}, {}, true}, {});
    attribution.polish(fitted, {});  // as a diagnosis does with its best: sharp blows make a rough landscape
    attribution.survey(fitted);
    CHECK(empty.fit.chi2 > 2.0 * fitted.fit.chi2);
    CHECK(fitted.fit.chi2 / static_cast<double>(fitted.fit.samples) < 1.15);
    const Eigen::VectorXd truth = coordinates_of(trial, fitted.list);
    const Eigen::VectorXd sd =
        fitted.fit.information.completeOrthogonalDecomposition().pseudoInverse().diagonal().cwiseSqrt();
    for (Eigen::Index k = static_cast<Eigen::Index>(model.calibrated().size()); k < truth.size(); ++k) {
      if (fitted.list[static_cast<std::size_t>(k)].still) continue;  // the range of a curve
      INFO(fitted.list[static_cast<std::size_t>(k)].name << " is " << fitted.fit.point[k] << ", truth "
                                                         << truth[k]);
      CHECK(std::abs(fitted.fit.point[k] - truth[k]) < 5.0 * sd[k] + 1e-4 * std::abs(truth[k]));
    }
  }
}

TEST_CASE("effects see each other's terms whatever their order in the catalogue") {
  Catalogue one, other;
  one.add<LoadFriction>()
      .add<WarmFriction>()
      .add<Imbalance>()
      .add<DriveLag>()
      .add<Radiation>()
      .add<AmbientBias>();
  other.add<AmbientBias>()
      .add<Radiation>()
      .add<DriveLag>()
      .add<Imbalance>()
      .add<WarmFriction>()
      .add<LoadFriction>();
  Model joint = axis_model();
  joint.effects["load_friction"] = {{"share", 0.3}, {"transition_rad_per_s", 0.05}};
  joint.effects["warm_friction"] = {{"per_K", 0.02}};
  joint.effects["imbalance"] = {{"Nm", 0.006}, {"phase_rad", 0.5}};
  joint.effects["drive_lag"] = {{"lag_s", 0.03}};
  Model body = bench_model();
  body.effects["radiation"] = {{"emissive_area_m2", 0.02}};
  body.effects["ambient_bias"] = {{"bias_K", 5.0}};
  for (const auto& [model, recording] :
       {std::pair{joint, axis_inputs(300, 0.01, 3)}, std::pair{body, bench_inputs(200, 2.0, 3, true)}}) {
    Recording first = recording, second = recording;
    measure(first, model, 7, one);
    measure(second, model, 7, other);
    for (const Column& column : first.columns) {
      const Eigen::VectorXd* same = second.find(column.name);
      REQUIRE(same != nullptr);
      INFO(column.name);
      CHECK((column.values - *same).cwiseAbs().maxCoeff() <
            1e-9 * (1.0 + column.values.cwiseAbs().maxCoeff()));
    }
  }
}

TEST_CASE("the catalogue refuses what does not fit together, in a sentence that names it") {
  struct Wrong : ConstantTorque {
    static EffectInfo info() {
      EffectInfo one = ConstantTorque::info();
      one.parameters[0].index = 1;
      return one;
    }
  };
  struct Needy : ConstantTorque {
    static EffectInfo info() {
      EffectInfo one = ConstantTorque::info();
      one.needs = {Need::thermal_model};
      return one;
    }
  };
  struct Scaled : ConstantTorque {
    static EffectInfo info() {
      EffectInfo one = ConstantTorque::info();
      one.parameters[0].starts_relative_to = Input::power_param;
      return one;
    }
  };
  struct Stateful : Imbalance {
    static EffectInfo info() {
      EffectInfo one = Imbalance::info();
      one.states = {{"a", "1"}, {"b", "1"}, {"c", "1"}};
      return one;
    }
  };
  struct Alike : ConstantTorque {
    static EffectInfo info() {
      EffectInfo one = ConstantTorque::info();
      one.where_equal = WhereEqual{0, 1, "coulomb_friction"};
      return one;
    }
  };
  struct OfItself : AsymmetricFriction {
    static EffectInfo info() {
      EffectInfo one = AsymmetricFriction::info();
      one.where_equal->cause = one.id;
      return one;
    }
  };
  struct Mixed : AsymmetricFriction {
    static EffectInfo info() {
      EffectInfo one = AsymmetricFriction::info();
      one.where_equal->other = transition;
      return one;
    }
  };
  struct Slight : StribeckFriction {
    static EffectInfo info() {
      EffectInfo one = StribeckFriction::info();
      one.where_small->beside = knee_rad_per_s;
      return one;
    }
  };
  Catalogue catalogue;
  CHECK_THROWS_WITH(catalogue.add<Slight>(), ContainsSubstring("'knee_rad_per_s'") &&
                                                 ContainsSubstring("one of its parameters is small"));
  CHECK_THROWS_WITH(catalogue.add<Alike>(), ContainsSubstring("two places of the list"));
  CHECK_THROWS_WITH(catalogue.add<OfItself>(), ContainsSubstring("another cause"));
  CHECK_THROWS_WITH(catalogue.add<Mixed>(),
                    ContainsSubstring("'transition_rad_per_s'") && ContainsSubstring("same unit"));
  CHECK_THROWS_WITH(catalogue.add<Wrong>(), ContainsSubstring("'Nm'") && ContainsSubstring("number 1"));
  CHECK_THROWS_WITH(catalogue.add<Needy>(), ContainsSubstring("needs 'thermal'"));
  CHECK_THROWS_WITH(catalogue.add<Scaled>(),
                    ContainsSubstring("'Nm'") && ContainsSubstring("shares of an input"));
  CHECK_THROWS_WITH(catalogue.add<Stateful>(), ContainsSubstring("states"));
}
