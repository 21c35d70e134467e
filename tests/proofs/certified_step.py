# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The certified limiter's step and its decision, in the whole numbers in which they are computed.

A temperature is in units of 2^-18 K. Heat per count is proved for a whole count at once: every quantity "per count"
stands for itself times the count, and so does the rounding of what is made of it.
"""
import z3

from header_formulas import function
from linear import Facts, Linear
from whole_numbers import require

# What a bound may lie above its limit by rounding: less than half of the 131 units that every limit is kept low.
INSIDE = 62
# What validate() asks of the limits beyond the raises: twice rounding_units().
SPARE = 128


class Node:
    none, winding, body = 0, 1, 2


class Record:
    pass


class Part:
    """A part of a distance, as `? :` chooses it."""

    def __init__(self, fraction):
        self.fraction = fraction


class Bound:
    """UpperBound: a value, and its whole part below it."""

    def __init__(self, facts, name):
        self.facts = facts
        self.value, self.whole = facts.variable(name), facts.variable(name + " whole")
        facts.add(self.whole <= self.value, self.value <= self.whole + 1)

    def kept(self):
        copy = object.__new__(Bound)
        copy.__dict__.update(self.__dict__)
        return copy

    def below(self):
        return self.whole

    def above(self):
        return self.whole + 1

    def raise_(self, floor):
        is_low = self.whole < floor
        self.value, self.whole = (self.facts.choice(is_low, floor, self.value),
                                  self.facts.choice(is_low, floor, self.whole))

    def advance(self, distance, chosen):
        condition, heating, cooling = chosen
        self.started = self.whole + 1
        value, whole = self.facts.fresh("value"), self.facts.fresh("whole")
        self.facts.add(
            z3.Implies(condition, value.same(self.value + self.facts.product(distance, heating))),
            z3.Implies(z3.Not(condition), value.same(self.value + self.facts.product(distance, cooling))),
            whole <= value, value <= whole + 1)
        self.value, self.whole = value, whole


class Decision:
    """CertifiedCount: what each condition asks of the count."""

    def __init__(self, *_):
        self.conditions = []

    def fit(self, room, size, _node):
        self.conditions.append((Linear.of(room), Linear.of(size)))

    def keep(self, room, node):
        self.fit(room, 0, node)


class Header:
    """The functions of a network's header over one set of facts."""

    def __init__(self, text, signatures, other_text="", other_signatures=()):
        self.facts = Facts()
        self.unit = 1
        self.per_count = {}  # variable per count -> by how much rounding its part may raise it
        self.rounded = {}  # (direction, fraction) -> [(argument, result)]
        names = {
            "ite": self.ite, "part_up": self.part_up, "part_down": self.part_down, "times": self.times,
            "blank": Record, "record": self.record, "CertifiedNode": Node, "soaked_late": lambda _count: None,
            "fit_horizon": lambda *_: None}  # it only makes a count smaller: nothing is learned from it
        self.functions = {name: function(text, signature, name, arguments, names)
                          for name, signature, arguments in signatures}
        self.functions.update({name: function(other_text, signature, name, arguments, names)
                               for name, signature, arguments in other_signatures})
        self.rooms, self.choices = [], []
        self.rounding_units = lambda: 64

    def __getattr__(self, name):
        if name == "functions" or name not in self.functions:
            raise AttributeError(name)

        def call(*arguments):
            result = self.functions[name](self, *arguments)
            if name == "room":
                self.rooms.append(result)
            return result
        return call

    def record(self, *values):
        return Decision() if values and isinstance(values[0], int) and values[0] == 254 else values

    def ite(self, condition, yes, no):
        if condition is True or condition is False:
            return yes if condition else no
        if isinstance(yes, Part):
            return condition, yes.fraction, no.fraction
        self.choices.append((yes, no))
        return self.facts.choice(condition, yes, no)

    def rounded_product(self, direction, argument, fraction):
        result, argument = self.facts.fresh(direction), Linear.of(argument)
        product = self.facts.product(argument, fraction)
        unit = self.per_count.get("".join(argument.terms), self.unit)
        if direction == "up":
            self.facts.add(result >= product, result <= product + unit)
        else:
            self.facts.add(result <= product, result >= product - unit)
        # A rounded product of whole numbers does not fall, and moves no farther than its argument.
        if isinstance(unit, int):
            before = self.rounded.setdefault((direction, fraction.single()), [])
            for other, other_result in before:
                apart, moved = argument - other, result - other_result
                self.facts.add(z3.Implies(apart >= 0, z3.And(moved >= 0, moved <= apart)),
                               z3.Implies(apart <= 0, z3.And(moved <= 0, moved >= apart)))
            before.append((argument, result))
        return result

    def part_up(self, argument, fraction):
        return self.rounded_product("up", argument, fraction)

    def part_down(self, argument, fraction):
        return self.rounded_product("down", argument, fraction)

    @staticmethod
    def times(per_count, acting):
        return acting[per_count.single()] if acting else Linear()


class Step:
    def __init__(self, facts, holds):
        self.is_late = False
        for name, hold in holds.items():
            part = Record()
            part.heating = Part(facts.fraction(name + " heating", at_most=hold))
            part.cooling = Part(facts.fraction(name + " cooling"))
            setattr(self, name, part)


def acting_at_most(facts, granted):
    """Any count from none to the granted one."""
    acting = {}
    for name in granted:
        acting[name] = facts.variable("acting " + name)
        facts.add(acting[name] >= 0, acting[name] <= facts.variable(name))
    return acting


TWO_NODE = [("carry", r"Hull carry\(", ["self", "count", "step"]), ("room", r"Room room\(", ["self"]),
            ("largest", r"CertifiedCount largest\(", ["self"]), ("take", r"void take\(", ["self", "winding", "body"]),
            ("settled", r"KelvinUnits settled\(", ["self"]), ("sizes", r"Sizes sizes\(", ["self"])]
ONE_NODE = [("carry", r"KelvinUnits carry\(", ["self", "count", "step"]),
            ("room", r"KelvinUnits room\(", ["self"]), ("largest", r"CertifiedCount largest\(", ["self"])]


def two_node(text, other_text="", other_signatures=()):
    """The network at any state that validate() and the safe set admit."""
    net = Header(text, TWO_NODE, other_text, other_signatures)
    facts = net.facts
    for name in ["base_", "gap_", "least_mean_", "winding_limit_", "mean_limit_", "across_", "soak_", "to_air_"]:
        setattr(net, name, facts.variable(name))
    for name in ["gap_", "least_mean_", "across_", "soak_", "to_air_"]:
        facts.add(getattr(net, name) >= 0)
    for name in ["weight_", "hold_winding_", "hold_body_", "horizon_winding_", "horizon_body_"]:
        setattr(net, name, facts.fraction(name))
    hottest = facts.variable("base in the hottest air")
    facts.add(net.base_ <= hottest)
    # What set_limits() compares before it accepts a declaration; certified_limits() pins its text.
    facts.add(facts.product(net.least_mean_ + net.gap_, net.weight_) <= net.least_mean_,
              hottest + net.least_mean_ + SPARE <= net.mean_limit_,
              net.mean_limit_ + net.gap_ + 2 <= net.winding_limit_,
              facts.product(net.winding_limit_ - hottest, net.weight_) <= net.mean_limit_ - hottest - SPARE)
    net.winding_, net.mean_ = Bound(facts, "winding"), Bound(facts, "mean")
    facts.add(net.winding_.value <= net.winding_limit_ + INSIDE, net.mean_.value <= net.mean_limit_ + INSIDE)
    return net


def stays_inside(net, passed=None):
    inside = [net.winding_.value <= net.winding_limit_ + INSIDE, net.mean_.value <= net.mean_limit_ + INSIDE]
    if passed:
        inside += [passed[0] <= net.winding_limit_ + INSIDE + 1, passed[1] <= net.mean_limit_ + INSIDE + 1]
    return z3.And(*inside)


def two_node_raises(text):
    net = two_node(text)
    room = net.room()
    # is_certified() allows 64 units.
    return net.facts.counterexample(z3.And(room.winding_left >= -64, room.mean_left >= -64))


def two_node_least_power(text):
    net = two_node(text)
    for name in ["across_now_", "soak_now_", "to_air_now_"]:
        setattr(net, name, net.facts.variable(name))
    step = Step(net.facts, {"winding": net.hold_winding_, "body": net.hold_body_})
    return net.facts.counterexample(stays_inside(net, net.carry(None, step)))


def granted(net):
    """The decision for a count of at least one, whose sizes are those of the whole count."""
    facts = net.facts
    count = facts.variable("count")
    facts.add(count >= 1, count <= 254)
    net.unit = count
    net.take(facts.fraction("winding relief"), facts.fraction("mean relief"))
    sizes = net.sizes()
    net.sizes = lambda: sizes
    fed_and_heated = sizes.fed - facts.variable("up_%d" % facts.made)
    net.unit = 1
    decision = net.largest()
    facts.add(*[size <= room for room, size in decision.conditions])
    return fed_and_heated


def two_node_granted_power(text):
    net = two_node(text)
    facts = net.facts
    step = Step(facts, {"winding": net.hold_winding_, "body": net.hold_body_})
    start = net.winding_.kept(), net.mean_.kept()
    fed = granted(net)
    net.winding_, net.mean_ = start
    room = net.rooms[0]
    rise, jump = net.across_now_ + net.soak_now_, net.sizes().jump
    acting = acting_at_most(facts, [x.single() for x in (net.across_now_, net.soak_now_, net.to_air_now_)])
    # Products that the solver compares others with.
    for argument, fraction in [
            (rise - room.apart, net.hold_winding_), (net.across_now_, net.hold_winding_),
            (net.to_air_now_, net.hold_body_), (room.winding + jump, net.weight_), (jump, net.weight_),
            (fed + net.to_air_now_ - (room.mean - room.weighted), net.hold_body_),
            (acting[net.across_now_.single()], step.winding.heating.fraction),
            (acting[net.to_air_now_.single()], step.body.heating.fraction)]:
        facts.product(argument, fraction)
    return facts.counterexample(stays_inside(net, net.carry(acting, step)))


def least_power_outside(net, outside):
    """Where a bound is outside of the safe set, a condition has no room: count_within() then gives 0, the least power."""
    decision = net.largest()
    return net.facts.counterexample(
        z3.Implies(outside(), z3.Or(*[room < 0 for room, _ in decision.conditions])))


def anywhere(text, other_text="", other_signatures=()):
    """The two-node network at any bounds at all, and any constants."""
    net = Header(text, TWO_NODE, other_text, other_signatures)
    for name in ["base_", "gap_", "least_mean_", "winding_limit_", "mean_limit_", "lead_now_"]:
        setattr(net, name, net.facts.variable(name))
    for name in ["weight_", "hold_winding_", "hold_body_", "hold_mean_", "horizon_winding_", "horizon_body_"]:
        setattr(net, name, net.facts.fraction(name))
    sizes = Record()
    for name in ["slow", "slow_winding", "held_winding", "jump", "held_body", "fed", "held_warmest", "held_coolest"]:
        setattr(sizes, name, Linear())
    for name in ["across_now_", "soak_now_", "to_air_now_", "to_air_hot_"]:
        setattr(net, name, Linear())
    net.sizes = net.end_sizes = lambda: sizes
    net.winding_, net.mean_ = Bound(net.facts, "winding"), Bound(net.facts, "mean")
    return net


def two_node_outside(text):
    net = anywhere(text)
    return least_power_outside(
        net, lambda: z3.Or(net.rooms[0].winding_left < -64, net.rooms[0].mean_left < -64))


def coupled_outside(text, of_two):
    net = anywhere(of_two, text, COUPLED)
    return least_power_outside(
        net, lambda: z3.Or(net.rooms[0].winding_left < -64, net.rooms[0].mean_left < -64))


def one_node_outside(text):
    net = Header(text, ONE_NODE)
    for name in ["base_", "limit_", "to_air_now_"]:
        setattr(net, name, net.facts.variable(name))
    for name in ["hold_", "horizon_"]:
        setattr(net, name, net.facts.fraction(name))
    net.node_ = Bound(net.facts, "node")
    return least_power_outside(net, lambda: net.limit_ - net.base_ - net.rooms[0] < -64)


CHAIN = [("fit_hold", r"void fit_hold\(", ["self", "largest", "k"])]


def chain_outside(text):
    """Of any mean of a chain; largest() asks every one of them, and is_certified() the same of each."""
    require(text, "for (uint8_t k = node_count; k-- > 0;) { const uint8_t before = largest.count; "
            "fit_hold(largest, k);",
            "for (uint8_t k = 0; k < node_count; ++k) if (bounds_[k].below() > fixed_.box[k]) return false; return true;")
    net = Header(text, CHAIN)
    box = net.facts.variable("box")
    net.fixed_ = Record()
    net.fixed_.box, net.fixed_.hold = {0: box}, {0: net.facts.fraction("hold")}
    net.bounds_ = {0: Bound(net.facts, "mean")}
    net.still_end = lambda _k: net.facts.variable("still")
    net.end_per_count = lambda _k: net.facts.variable("end")
    decision = Decision()
    net.fit_hold(decision, 0)
    return net.facts.counterexample(z3.Implies(
        net.bounds_[0].below() > box, z3.Or(*[room < 0 for room, _ in decision.conditions])))


def hotter(facts, before):
    after = Bound(facts, before.value.single() + " hotter")
    facts.add(after.value >= before.value, after.whole >= before.whole)
    return after


def no_room_grows(net, bounds):
    """No condition leaves more room when any of the bounds is hotter, at the same heat per count."""
    cold = net.largest()
    for name in bounds:
        setattr(net, name, hotter(net.facts, getattr(net, name)))
    hot = net.largest()
    assert cold.conditions and len(cold.conditions) == len(hot.conditions)
    return net.facts.counterexample(
        z3.And(*[h[0] <= c[0] for h, c in zip(hot.conditions, cold.conditions)]))


def two_node_hotter(text):
    net = Header(text, TWO_NODE)
    for name in ["base_", "gap_", "least_mean_", "winding_limit_", "mean_limit_"]:
        setattr(net, name, net.facts.variable(name))
    for name in ["weight_", "hold_winding_", "hold_body_", "horizon_winding_", "horizon_body_"]:
        setattr(net, name, net.facts.fraction(name))
    sizes = Record()
    for name in ["slow", "slow_winding", "held_winding", "jump", "held_body", "fed"]:
        setattr(sizes, name, Linear())
    net.sizes = lambda: sizes
    net.winding_, net.mean_ = Bound(net.facts, "winding"), Bound(net.facts, "mean")
    return no_room_grows(net, ["winding_", "mean_"])


COUPLED = [("carry", r"Hull carry\(", ["self", "count", "step"]),
           ("largest", r"CertifiedCount largest\(", ["self"]), ("end_sizes", r"EndSizes end_sizes\(", ["self"])]


def coupled(text, of_two):
    """The network that takes both ends: its own step and decision, everything else of the two-node network."""
    net = two_node(of_two, text, COUPLED)
    net.hold_mean_ = net.facts.fraction("hold_mean_")
    net.lead_now_ = net.facts.variable("lead_now_")
    net.facts.add(net.lead_now_ >= 0)
    return net


def coupled_step(net):
    step = Step(net.facts, {"winding": net.hold_winding_, "body": net.hold_body_})
    step.mean_rise = Part(net.facts.fraction("mean_rise", at_most=net.hold_mean_))
    return step


def coupled_least_power(text, of_two):
    net = coupled(text, of_two)
    for name in ["across_now_", "soak_now_", "to_air_now_", "to_air_hot_"]:
        setattr(net, name, net.facts.variable(name))
    return net.facts.counterexample(stays_inside(net, net.carry(None, coupled_step(net))))


def coupled_granted_power(text, of_two):
    net = coupled(text, of_two)
    facts = net.facts
    step = coupled_step(net)
    start = net.winding_.kept(), net.mean_.kept()
    count = facts.variable("count")
    facts.add(count >= 1, count <= 254)
    net.unit = count
    net.take(facts.fraction("winding relief"), facts.fraction("mean relief"))
    net.to_air_hot_ = net.part_up(net.to_air_, facts.fraction("warm end's relief"))
    # take_at(): the smaller relief, of the same heat.
    facts.add(net.to_air_hot_ <= net.to_air_now_)
    sizes = net.end_sizes()
    net.end_sizes = lambda: sizes
    fed = sizes.fed - facts.variable("up_%d" % facts.made)
    net.unit = 1
    decision = net.largest()
    room = net.rooms[0]
    # take_warm_winding(): not more than what the bounds are apart.
    facts.add(net.lead_now_ <= room.winding - room.mean)
    facts.add(*[size <= room for room, size in decision.conditions])
    net.winding_, net.mean_ = start
    rise = net.across_now_ + net.soak_now_
    names = [x.single() for x in (net.across_now_, net.soak_now_, net.to_air_now_, net.to_air_hot_)]
    acting = acting_at_most(facts, names)
    facts.add(acting[names[3]] <= acting[names[2]])
    jump, warmest_spare = sizes.jump, room.mean - room.weighted
    for argument, fraction in [
            (rise - room.apart, net.hold_winding_), (net.across_now_, net.hold_winding_),
            (room.winding + jump, net.weight_), (jump, net.weight_), (net.lead_now_, net.weight_),
            (room.mean + net.lead_now_, net.weight_),
            (fed + net.to_air_hot_ - warmest_spare, net.hold_mean_),
            (net.to_air_now_, net.hold_mean_), (net.to_air_hot_, net.hold_mean_),
            (acting[names[0]], step.winding.heating.fraction), (acting[names[2]], step.mean_rise.fraction),
            (acting[names[3]], step.mean_rise.fraction)]:
        facts.product(argument, fraction)
    led = next((result for argument, result in net.rounded["up", net.weight_.single()]
                if net.lead_now_.single() in argument.terms), room.mean)
    chosen_before = len(net.choices)
    passed = net.carry(acting, step)
    warmest_distance, coolest_distance = net.choices[chosen_before + 2]
    started = net.mean_.started - net.base_
    coolest_spare = room.mean - led
    for argument, fraction in [
            (started - room.mean, net.weight_), (started, net.weight_), (warmest_distance, net.hold_mean_),
            (coolest_distance, net.hold_mean_), (coolest_distance - acting[names[2]], net.hold_mean_),
            (warmest_distance - acting[names[3]], net.hold_mean_), (acting[names[2]], net.hold_mean_),
            (acting[names[3]], net.hold_mean_), (started - room.mean, net.hold_mean_),
            (-coolest_spare, net.hold_mean_), (net.to_air_now_ - coolest_spare, net.hold_mean_),
            (acting[names[2]] - coolest_spare, net.hold_mean_)]:
        facts.product(argument, fraction)
    return facts.counterexample(stays_inside(net, passed))


def one_node(text):
    net = Header(text, ONE_NODE)
    facts = net.facts
    for name in ["base_", "limit_", "to_air_now_"]:
        setattr(net, name, facts.variable(name))
    for name in ["hold_", "horizon_"]:
        setattr(net, name, facts.fraction(name))
    facts.add(net.to_air_now_ >= 0, net.base_ <= net.limit_)
    net.node_ = Bound(facts, "node")
    facts.add(net.node_.value <= net.limit_ + INSIDE)
    return net


def one_node_least_power(text):
    net = one_node(text)
    passed = net.carry(None, Step(net.facts, {"body": net.hold_}))
    return net.facts.counterexample(
        z3.And(net.node_.value <= net.limit_ + INSIDE, passed <= net.limit_ + INSIDE + 1))


def one_node_granted_power(text):
    net = one_node(text)
    facts = net.facts
    step = Step(facts, {"body": net.hold_})
    start = net.node_.kept()
    count = facts.variable("count")
    facts.add(count >= 1, count <= 254)
    net.per_count[net.to_air_now_.single()] = count
    decision = net.largest()
    facts.add(*[size <= room for room, size in decision.conditions])
    net.node_ = start
    acting = acting_at_most(facts, [net.to_air_now_.single()])
    facts.product(net.to_air_now_ - net.rooms[0], net.hold_)
    passed = net.carry(acting, step)
    return facts.counterexample(
        z3.And(net.node_.value <= net.limit_ + INSIDE, passed <= net.limit_ + INSIDE + 1))


def one_node_hotter(text):
    return no_room_grows(one_node(text), ["node_"])
