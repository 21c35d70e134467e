# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Proves what docs/explain/certified-limiter.md claims of the certified limiter, from the text of its headers.

    python3 tests/proofs/prove.py            every claim, with what proves it
    python3 tests/proofs/prove.py --mutants  breaks the formulas one at a time: each must be found out

Needs python3-z3; gappa for the roundings of the float constants. The exit status is 0 only when all holds.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import z3  # noqa: E402

import certified_step  # noqa: E402
import physics  # noqa: E402
import whole_numbers  # noqa: E402
from header_formulas import NotUnderstood  # noqa: E402

CONTROL = os.path.join(HERE, "..", "..", "include", "thermopower", "control")
TWO, ONE, BOUNDS, ARITHMETIC = ("certified/two_node.hpp", "certified/one_node.hpp", "certified/bounds.hpp",
                                "certified/arithmetic.hpp")
COUPLED, CHAIN = "certified/coupled_two_node.hpp", "certified/chain.hpp"


def header(name, mutation=None):
    with open(os.path.join(CONTROL, name), encoding="utf-8") as file:
        text = file.read()
    if mutation and mutation[0] == name:
        if text.count(mutation[1]) != 1:
            raise SystemExit("prove.py: the mutation's text stands %d times in %s: %s" %
                             (text.count(mutation[1]), name, mutation[1]))
        text = text.replace(mutation[1], mutation[2])
    return text


def roundings(bounds, two):
    """The float arithmetic that makes the constants, by Gappa; the statements it stands for are the header's."""
    whole_numbers.require(
        bounds, "return x < 1.0f ? x * (1.0f - x * (0.5f - x * (1.0f / 6.0f))) : 1.0f;",
        "const float below = slow < 1.0f ? slow * (1.0f - 0.5f * slow) : 0.5f;")
    whole_numbers.require(
        two, "const float count_W = use.heat.heat_when_cold_W * (detail::whole_margin() / 255.0f); "
        "across = detail::kelvin_per_count_up(count_W / winding_rate); "
        "soak = detail::kelvin_per_count_up(count_W * use.hold_s / (winding.lowest + body.lowest)); "
        "to_air = detail::kelvin_per_count_up(count_W / body_rate);",
        "const float winding_share = body.highest / (winding.lowest + body.highest);",
        "const float body_share = body.lowest / (winding.highest + body.lowest);",
        "winding_rate = config.least_coupling_W_per_K / winding_share; "
        "body_rate = config.least_conductance_W_per_K / body_share;")
    if shutil.which("gappa") is None:
        return "skipped: gappa is not installed"
    done = subprocess.run(["gappa", os.path.join(HERE, "float_constants.gappa")], capture_output=True, text=True,
                          check=False)
    return None if done.returncode == 0 else done.stderr


# name, what it is read from, function, the claim.
CLAIMS = [
    ("cooperative", [], physics.cooperative, "(4) more heat, warmer air or a warmer node never cools another node"),
    ("winding warmer", [], physics.winding_stays_warmer, "(9) the order air <= body <= winding is kept"),
    ("body below mean", [], physics.body_below_mean,
     "(10) body <= mean <= winding, and without power the mean does not rise"),
    ("winding equation", [], physics.winding_equation, "(18) the carried equation lies above the winding's own"),
    ("mean equation", [], physics.mean_equation, "(20) the carried equation lies above the mean's own, after (13)"),
    ("lead equation", [], physics.lead_equation, "(37), (38) the carried lead lies below the winding's own"),
    ("two ends", [], physics.two_ends,
     "(39) to (41) the mean's rate is highest at one end, and the carried line lies above both"),
    ("travel", [], physics.travel_fractions, "the parts of the way lie above and below 1 - exp(-x), for every x >= 0"),
    ("whole margin", [], physics.whole_margin, "a part that ends at 1 - 2^-16 is made up for by the heat's margin"),
    ("part_down", [ARITHMETIC], whole_numbers.part_down, "part_down is floor(value fraction / 65536), part_up above it"),
    ("advance", [ARITHMETIC], whole_numbers.advance, "UpperBound::advance adds distance * fraction exactly"),
    ("count_within", [ARITHMETIC], whole_numbers.count_within, "the long division gives the largest count that fits"),
    ("limits", [TWO], whole_numbers.certified_limits, "validate() accepts only what the next three start from"),
    ("two nodes: raises", [TWO], certified_step.two_node_raises,
     "(13), (14) from any bounds in the safe set, in any air, the raised bounds are in it"),
    ("two nodes: least power", [TWO], certified_step.two_node_least_power,
     "(15) the least power, for any part of a hold, leaves no bound outside"),
    ("two nodes: granted power", [TWO], certified_step.two_node_granted_power,
     "(23) to (26) nor does any count up to the one that largest() grants"),
    ("two nodes: hotter", [TWO], certified_step.two_node_hotter,
     "at the same heat per count, hotter bounds are never granted more"),
    ("both ends: least power", [COUPLED, TWO], certified_step.coupled_least_power, "the same as (15)"),
    ("both ends: granted power", [COUPLED, TWO], certified_step.coupled_granted_power, "the same for (42)"),
    ("one node: least power", [ONE], certified_step.one_node_least_power, "the same as (15)"),
    ("one node: granted power", [ONE], certified_step.one_node_granted_power, "the same as (23)"),
    ("two nodes: outside", [TWO], certified_step.two_node_outside,
     "as long as a bound is outside of the safe set, the answer is the least power"),
    ("both ends: outside", [COUPLED, TWO], certified_step.coupled_outside, "the same"),
    ("one node: outside", [ONE], certified_step.one_node_outside, "the same"),
    ("chain: outside", [CHAIN], certified_step.chain_outside, "the same of every mean of any chain"),
    ("one node: hotter", [ONE], certified_step.one_node_hotter, "at the same heat per count, hotter is never granted more"),
    ("SafetyLimiter: hotter", ["safety_limiter.hpp"], whole_numbers.safety_limiter,
     "of two equal histories and rates the hotter one never has the higher ceiling, whatever the rounding"),
    ("NodeLimiter: hotter", ["node_limiter.hpp"], whole_numbers.node_limiter,
     "a part nearer to its limit never has the higher ceiling"),
    ("float constants", [BOUNDS, TWO], roundings, "floats lose less than an eighth of the margin that is added"),
]

# Each breaks one formula. What must find it out: a claim whose counterexample z3 then has.
MUTANTS = [
    ("the count forgets what soaks in", (TWO, "size.jump = soak_now_ + detail::part_up(across_now_, hold_winding_);",
                                         "size.jump = detail::part_up(across_now_, hold_winding_);")),
    ("the winding's condition is left out", (TWO, "largest.fit(room.winding_left + room.apart, size.jump, "
                                                  "CertifiedNode::winding);", "")),
    ("the winding's hold is left out", (TWO, "size.held_winding = detail::part_up(rise, hold_winding_);",
                                        "size.held_winding = 0;")),
    ("the body's hold is left out", (TWO, "size.held_body = detail::part_up(fed + to_air_now_, hold_body_);",
                                     "size.held_body = 0;")),
    ("the body is not fed by the winding", (TWO, "size.fed = fed + detail::part_up(to_air_now_, hold_body_);",
                                            "size.fed = detail::part_up(to_air_now_, hold_body_);")),
    ("a spare counted twice", (TWO, "largest.fit(room.mean_left + spare, size.fed, CertifiedNode::body);",
                               "largest.fit(room.mean_left + spare + spare, size.fed, CertifiedNode::body);")),
    ("heating goes the cooling's way", (TWO, "winding_distance > 0 ? step.winding.heating : step.winding.cooling",
                                        "winding_distance > 0 ? step.winding.cooling : step.winding.heating")),
    ("no raise by (13)", (TWO, "if (room.mean < room.weighted) room.mean = room.weighted;", "")),
    ("the gap is left out of the soaking", (TWO, "mean_.above() + gap_ + detail::times(soak_now_, count);",
                                            "mean_.above() + gap_ + gap_ + detail::times(soak_now_, count);")),
    ("a horizon that gives the hot one more", (TWO, "detail::part_down(room.apart + lost, horizon_winding_)",
                                               "detail::part_down(room.apart, horizon_winding_) + lost")),
    ("limits without the spare", (TWO, "detail::part_up(winding_limit - base, weight) <= mean_limit - base - spare;",
                                  "detail::part_up(winding_limit - base, weight) <= mean_limit - base;")),
    ("both ends: the cool end is left out", (COUPLED, "size.held_coolest = detail::part_up(to_air_now_, hold_mean_);",
                                             "size.held_coolest = 0;")),
    ("both ends: the warm end is left out", (COUPLED, "size.held_warmest = detail::part_up(fed + to_air_hot_, hold_mean_);",
                                             "size.held_warmest = 0;")),
    ("both ends: the raised mean is not heated", (COUPLED, "size.fed = fed + detail::part_up(to_air_now_, hold_mean_);",
                                                  "size.fed = fed;")),
    ("both ends: the winding's jump is left out",
     (COUPLED, "size.jump = soak_now_ + detail::part_up(across_now_, hold_winding_);", "size.jump = 0;")),
    ("both ends: no lead in the decision", (COUPLED, "detail::part_up(room.mean + lead_now_, weight_)",
                                            "detail::part_up(room.mean, weight_)")),
    ("both ends: cooling at the heating's pace", (COUPLED, "distance > 0 ? step.mean_rise : step.body.cooling",
                                                  "distance < 0 ? step.mean_rise : step.winding.heating")),
    ("one node: no room taken off", (ONE, "left = limit_ - base_ - above;", "left = limit_ - base_;")),
    ("one node: the hold is left out",
     (ONE, "largest.fit(left + detail::part_down(above, hold_), detail::part_up(to_air_now_, hold_),\n"
           "                CertifiedNode::body);", "")),
    ("one node: cooling at the heating's pace",
     (ONE, "node_.advance(distance, distance > 0 ? step.body.heating : step.body.cooling);\n    return",
      "node_.advance(distance + distance, distance > 0 ? step.body.heating : step.body.cooling);\n    return")),
    ("two nodes: power outside", (TWO, "largest.keep(room.winding_left + rounding_units(), CertifiedNode::winding);", "")),
    ("both ends: power outside", (COUPLED, "largest.keep(room.mean_left + rounding_units(), CertifiedNode::body);", "")),
    ("one node: power outside", (ONE, "largest.keep(left + rounding_units(), CertifiedNode::body);", "")),
    ("chain: power outside", (CHAIN, "largest.keep(box - bounds_[k].below(), CertifiedNode::body);", "")),
    ("a product rounded once less", (ARITHMETIC, "return part_down(value, fraction) + 1;",
                                     "return part_down(value, fraction);")),
    ("a series that ends below", (BOUNDS, "(0.5f - x * (1.0f / 6.0f))", "(0.5f - x * (1.0f / 7.0f))")),
]


def prove(claims, mutation=None, quiet=False):
    """The claims that do not hold, with why; of a mutation the first of them."""
    broken = []
    for name, read, proof, claim in claims:
        begun, skipped = time.time(), None
        try:
            found = proof(*[header(one, mutation) for one in read])
            if isinstance(found, str) and found.startswith("skipped"):
                found, skipped = None, found
        except (NotUnderstood, whole_numbers.Changed, RuntimeError) as error:
            found = error
        if found is not None:
            broken.append((name, found))
        if broken and mutation:
            break
        if not quiet:
            state = skipped or ("proved" if found is None else "NOT PROVED")
            print("%-26s %-11s %5.2f s  %s" % (name, state, time.time() - begun, claim))
            if found is not None:
                print(re.sub(r"\s+", " ", str(found))[:2000])
    return broken


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--mutants", action="store_true", help="break each formula; each must be found out")
    if not arguments.parse_args().mutants:
        broken = prove(CLAIMS)
        print("%d of %d claims hold" % (len(CLAIMS) - len(broken), len(CLAIMS)))
        return 1 if broken else 0
    survivors = 0
    for name, mutation in MUTANTS:
        # The likeliest first: the claims about granted power.
        read = sorted((c for c in CLAIMS if mutation[0] in c[1]), key=lambda c: "granted" not in c[0])
        broken = prove(read, mutation, quiet=True)
        how = "; ".join("%s: %s" % (claim, "counterexample" if isinstance(found, z3.ModelRef) else
                                    type(found).__name__) for claim, found in broken)
        print("%-42s %s" % (name, how or "SURVIVES"))
        survivors += not broken
    print("%d of %d broken formulas are found out" % (len(MUTANTS) - survivors, len(MUTANTS)))
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
