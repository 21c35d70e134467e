// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/plant/quantity.hpp>
#include <thermopower/plant/signal.hpp>
#include <thermopower/plant/submodel.hpp>

#include <set>
#include <string>

using namespace thermopower::plant;

namespace {

template <class Known>
void check_set() {
  std::set<std::string> names;
  for (int i = 0; i < count_of(Known{}); ++i) {
    const Known one = static_cast<Known>(i);
    const std::string text = to_string(one);
    INFO(text);
    CHECK_FALSE(text.empty());
    CHECK(names.insert(text).second);
    CHECK(OpenName<Known>(text) == one);
    CHECK(OpenName<Known>(text).known() == one);
  }
}

}  // namespace

TEST_CASE("every member of a closed set has a name of its own, and is found by it") {
  check_set<Signal>();
  check_set<Submodel>();
  check_set<Quantity>();
}

TEST_CASE("a name that the set does not list is carried through, and equals only itself") {
  const SubmodelName valve("tank.valve");
  CHECK(to_string(valve) == "tank.valve");
  CHECK_FALSE(valve.known());
  CHECK(valve == SubmodelName("tank.valve"));
  CHECK(valve != SubmodelName("tank.wall"));
  CHECK(valve != Submodel::electrical);
  CHECK(Submodel::electrical != valve);
}

TEST_CASE("what holds a value per signal has as many as the plant has signals") {
  PerSignal<double> own(2, 1.5);
  own[static_cast<Signal>(1)] = 3.0;
  CHECK(own.count() == 2);
  CHECK(own[static_cast<Signal>(0)] == 1.5);
  CHECK(own[static_cast<Signal>(1)] == 3.0);
  CHECK(PerSignal<int>().count() == actuator_signal_count);
}
