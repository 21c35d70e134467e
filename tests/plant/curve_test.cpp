// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Curves, against the functions that they are to follow, and against firmware's.
#include "../catch.hpp"

#include <thermopower/actuator/curve.hpp>
#include <thermopower/plant/curve.hpp>
#include <thermopower/plant/curve_id.hpp>
#include <thermopower/plant/derivative.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace thermopower::plant;

namespace {

constexpr double from = -30.0, to = 60.0;

/// Parameters of a curve through a function.
template <class Function>
std::vector<double> through(Function&& function) {
  std::vector<double> p{from, to};
  for (int i = 0; i < curve_knot_count; ++i)
    p.push_back(function(from + (to - from) * i / (curve_knot_count - 1)));
  return p;
}

double at(const std::vector<double>& p, double x) { return curve_at<double>("", p.data(), x); }

}  // namespace

TEST_CASE("a curve passes through its knots, is exact on a line and keeps its value beyond the ends") {
  const auto line = [](double x) { return 0.5 - 0.02 * x; };
  const auto bent = [](double x) { return std::sin(0.03 * x); };
  const std::vector<double> straight = through(line), curved = through(bent);
  for (double x = from; x <= to; x += 0.7) CHECK(at(straight, x) == Approx(line(x)));
  for (int i = 0; i < curve_knot_count; ++i) {
    const double x = from + (to - from) * i / (curve_knot_count - 1);
    CHECK(at(curved, x) == Approx(bent(x)).margin(1e-12));
  }
  for (const double beyond : {1.0, 1e3, 1e9}) {
    CHECK(at(curved, from - beyond) == Approx(bent(from)));
    CHECK(at(curved, to + beyond) == Approx(bent(to)));
  }
}

TEST_CASE("between its knots a curve follows a smooth function to the cube of their distance") {
  const auto bent = [](double x) { return std::sin(0.03 * x); };
  const std::vector<double> p = through(bent);
  const double step = 0.03 * (to - from) / (curve_knot_count - 1);  // radians from knot to knot
  for (double x = from; x <= to; x += 0.3) CHECK(std::abs(at(p, x) - bent(x)) < 0.1 * step * step * step);
}

TEST_CASE("derivatives of a curve by its knots and by its variable are those of its values") {
  const std::vector<double> p = through([](double x) { return 1e-3 * x * x; });
  for (double x = from - 5.0; x < to + 5.0; x += 1.7) {
    CAPTURE(x);
    std::vector<Dual> seeded(p.begin(), p.end());
    const int knot = 4;
    seeded[static_cast<std::size_t>(curve_support_count + knot)].seed(0);
    Dual where(x);
    where.seed(1);
    const Dual value = curve_at("", seeded.data(), where);
    CHECK(value.value() == Approx(at(p, x)));
    std::vector<double> above = p;
    above[static_cast<std::size_t>(curve_support_count + knot)] += 1.0;
    CHECK(value.slope(0) == Approx(at(above, x) - at(p, x)).margin(1e-6));
    const double h = 1e-4;
    CHECK(value.slope(1) == Approx((at(p, x + h) - at(p, x - h)) / (2.0 * h)).margin(2e-5));
  }
}

TEST_CASE("firmware's curve is the simulation's, and is not a number where its variable is none") {
  const std::vector<double> p = through([](double x) { return std::cos(0.05 * x); });
  std::vector<float> table(p.begin() + curve_support_count, p.end());
  const auto value = [&](float x) {
    return thermopower::curve_value(table.data(), curve_knot_count, static_cast<float>(from),
                                    static_cast<float>(to), x);
  };
  const auto slope = [&](float x) {
    return thermopower::curve_slope(table.data(), curve_knot_count, static_cast<float>(from),
                                    static_cast<float>(to), x);
  };
  for (double x = from - 20.0; x < to + 20.0; x += 0.9) {
    CHECK(static_cast<double>(value(static_cast<float>(x))) == Approx(at(p, x)).margin(1e-5));
    const double h = 1e-3, expected = (at(p, x + h) - at(p, x - h)) / (2.0 * h);
    CHECK(static_cast<double>(slope(static_cast<float>(x))) == Approx(expected).margin(1e-4));
  }
  CHECK(std::isnan(value(std::numeric_limits<float>::quiet_NaN())));
  CHECK(std::isnan(slope(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("a curve writes itself as one look-up, and its derivative as another") {
  const std::vector<double> p = through([](double x) { return x; });
  std::vector<Expression> written(p.begin(), p.end());
  Trace trace;
  const Expression x = trace.symbol("x"), value = curve_at("unknown.load(angle_deg)", written.data(), x);
  REQUIRE_FALSE(value.is_constant());
  const Trace::Node& node = trace.nodes()[static_cast<std::size_t>(value.node())];
  CHECK(node.kind == Trace::Kind::curve);
  CHECK(trace.curve_of(node.name).values.size() == static_cast<std::size_t>(curve_knot_count));
  const Expression slope = derivative(value, x);
  CHECK(trace.nodes()[static_cast<std::size_t>(slope.node())].kind == Trace::Kind::curve_slope);
  CHECK(curve_at("", written.data(), Expression(7.0)).constant_value() == Approx(7.0));
}

TEST_CASE("curves are told by their ids, wait for a range, and are refused an empty one") {
  Catalogue catalogue = standard_catalogue();
  int curves = 0;
  for (const EffectInfo& info : catalogue.list()) {
    CAPTURE(info.id);
    CHECK(is_curve(info.id) == info.curve.has_value());
    if (!info.curve) continue;
    ++curves;
    CHECK(info.curve->size == 0.0);
    CHECK(info.parameters.size() == static_cast<std::size_t>(curve_support_count + curve_knot_count));
  }
  CHECK(curves == 6);
  catalogue.support("unknown.load(angle_deg)", -10.0, 20.0, 0.5);
  const EffectInfo& load = catalogue.find("unknown.load(angle_deg)")->info;
  CHECK(load.parameters[0].starts == std::vector<double>{-10.0});
  CHECK(load.parameters[1].starts == std::vector<double>{20.0});
  CHECK(load.curve->size == 0.5);
  CHECK_THROWS_AS(catalogue.support("unknown.load(angle_deg)", 20.0, 20.0, 0.5), InvalidInput);
  CHECK_THROWS_AS(catalogue.support("cable_spring", 0.0, 1.0, 1.0), InvalidInput);
}
