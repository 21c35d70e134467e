# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The products and the division of control/certified/arithmetic.hpp, for every argument.

The statements that are proved stand here as text and must be the header's: a changed header makes the proof fail until
the proof is changed with it.
"""
import re

import z3


class Changed(Exception):
    """The header no longer says what is proved."""


def require(text, *statements):
    plain = " ".join(re.sub(r"//[^\n]*", "", text).split())
    for statement in statements:
        if statement not in plain:
            raise Changed("not in the header any more: " + statement)


def falsified(facts, goal, seconds=100):
    solver = z3.Solver()
    solver.set("timeout", 1000 * seconds)
    solver.add(*facts)
    solver.add(z3.Not(goal))
    found = solver.check()
    if found == z3.unknown:
        raise RuntimeError("z3 could not decide: " + solver.reason_unknown())
    return None if found == z3.unsat else solver.model()


def part_down(text):
    """floor(value * fraction / 65536). value = 65536 high + low; the two products are any that they can be."""
    require(text, "const int16_t high = static_cast<int16_t>(value >> 16);",
            "const uint16_t low = static_cast<uint16_t>(value);",
            "return static_cast<int32_t>(high) * fraction + "
            "static_cast<int32_t>((static_cast<uint32_t>(low) * fraction) >> 16);",
            "inline int32_t part_up(int32_t value, UnitFraction fraction) noexcept { "
            "return part_down(value, fraction) + 1; }")
    high_part, low_part = z3.Ints("high*fraction low*fraction")
    return falsified([low_part >= 0], high_part + low_part / 65536 == (65536 * high_part + low_part) / 65536)


def advance(text):
    """UpperBound::advance adds distance * fraction exactly, modulo nothing: four products of 16 bits, and the sign."""
    require(text, "const uint32_t lowest = product(distance_low, fraction_low), other = product(distance_high, fraction_low);",
            "uint32_t middle = (lowest >> 16) + static_cast<uint16_t>(other); uint32_t upper = other >> 16;",
            "if (fraction_high != 0) { const uint32_t another = product(distance_low, fraction_high); "
            "middle += static_cast<uint16_t>(another); "
            "upper += product(distance_high, fraction_high) + (another >> 16); } upper += middle >> 16; "
            "if (distance < 0) upper -= fraction;",
            "const uint32_t added = (middle << 16) | static_cast<uint16_t>(lowest); low_ += added; "
            "if (low_ < added) ++upper; "
            "high_ = static_cast<KelvinUnits>(static_cast<uint32_t>(high_) + upper);")
    # Each product of 16 bits by its halves, and what the carries make of them; the rest is addition.
    whole, half = 2 ** 32, 2 ** 16
    lowest, other, another, both = [z3.Ints(name + "_high " + name + "_low")
                                    for name in ("lowest", "other", "another", "both")]
    facts = [z3.And(0 <= part, part < half) for pair in (lowest, other, another, both) for part in pair]
    middle, carried = z3.Ints("middle carried")
    facts += [middle == lowest[0] + other[1] + another[1] - half * carried, 0 <= middle, middle < half]
    value = lambda pair: pair[0] * half + pair[1]
    upper, added = other[0] + value(both) + another[0] + carried, middle * half + lowest[1]
    product = falsified(facts, z3.And(
        upper * whole + added == value(lowest) + half * (value(other) + value(another)) + whole * value(both),
        lowest[0] + other[1] + another[1] < whole))
    if product is not None:
        return product
    # The carry of the lower halves, which the comparison finds; the sign takes a whole fraction off the upper half.
    low, plus, kept, carry = z3.Ints("low added kept carry")
    return falsified([0 <= low, low < whole, 0 <= plus, plus < whole, kept == low + plus - whole * carry, 0 <= kept,
                      kept < whole], z3.If(kept < plus, 1, 0) == carry)


def count_within(text):
    """The largest count 0 .. most with count * size <= room, by its long division."""
    require(text, "if (room < 0) return 0; if (times(size, most) <= room) return most;",
            "uint32_t left = static_cast<uint32_t>(room), part = static_cast<uint32_t>(size) << 7; uint8_t count = 0;",
            "for (uint8_t step = 0; step < 8; ++step) { count = static_cast<uint8_t>(count << 1); "
            "if (left >= part) { left -= part; ++count; } part >>= 1; }")
    size, room = z3.Ints("size room")
    # Where it comes to the division: 0 <= room < most * size, most <= 254, and most * size fits.
    facts = [room >= 0, size >= 1, room < 254 * size, 254 * size <= 0x7FFFFFFF]
    left, count, part_bits = room, z3.IntVal(0), 7
    for _ in range(8):
        part = size * 2 ** part_bits
        fits = left >= part
        left, count = z3.If(fits, left - part, left), 2 * count + z3.If(fits, 1, 0)
        part_bits -= 1
    # count * size = room - left holds by construction; what is left is less than one size.
    total = z3.IntVal(0)
    again = room
    for bits in range(7, -1, -1):
        fits = again >= size * 2 ** bits
        total = total + z3.If(fits, size * 2 ** bits, 0)
        again = z3.If(fits, again - size * 2 ** bits, again)
    return falsified(facts, z3.And(left >= 0, left < size, total == room - left, size * 128 < 2 ** 32))


def certified_limits(text):
    """What set_limits() compares is what the step's proof starts from."""
    require(text,
            "const detail::KelvinUnits spare = 2 * rounding_units();",
            "const bool is_kept = detail::part_up(least_mean + gap, weight) <= least_mean && "
            "base + least_mean + spare <= mean_limit && mean_limit + gap + 2 <= winding_limit && "
            "detail::part_up(winding_limit - base, weight) <= mean_limit - base - spare; "
            "feasible = is_kept ? ConfigError::none : ConfigError::highest_air_C;",
            "const float rounding_K = 0.0005f;",
            "static constexpr detail::KelvinUnits rounding_units() { return 64; }",
            "return room.winding_left >= -rounding_units() && room.mean_left >= -rounding_units();",
            "if (!travel.is_late) { travel.winding.end_at(hold_winding_); travel.body.end_at(hold_body_); }",
            "set_limits(config, detail::celsius_units(use.highest_air_C) + 2 + base_over_air);")
    return None


def safety_limiter(text):
    """SafetyLimiter with PerSecond: in floats, of two equal histories the hotter one never has the higher ceiling."""
    require(text,
            "state.ceiling = detail::at_least(state.ceiling - config.rate_per_s * dt_s, "
            "static_cast<float>(least_power()));",
            "state.ceiling = detail::at_most(state.ceiling + config.rate_per_s * dt_s, 255.0f);",
            "const float safety_C = config_.maximum_C - config_.safety_time_s * inputs.rate_K_per_s; "
            "const bool is_safe = inputs.motor_C <= safety_C; if (is_safe) Rule::raise(state_, config_, dt_s); "
            "else Rule::lower(state_, config_, dt_s);",
            "if (inputs.motor_C > config_.maximum_C) return cut(LimitReason::over_temperature, inputs.demand);",
            "static void cut(State& state) noexcept { state.ceiling = static_cast<float>(least_power()); }",
            "if (inputs.demand > ceiling) { granted.power = ceiling;")
    # Rounding is any function that does not fall and leaves floats as they are.
    cold, hot, limit, maximum, change = z3.Reals("cold hot safety_C maximum_C rate*dt")
    ceiling_cold, ceiling_hot = z3.Reals("ceiling_cold ceiling_hot")
    rounded = z3.Function("rounded", z3.RealSort(), z3.RealSort())
    least, most = z3.RealVal(1), z3.RealVal(255)
    floats = [least, most, ceiling_cold, ceiling_hot]
    sums = [ceiling + sign * change for ceiling in (ceiling_cold, ceiling_hot) for sign in (1, -1)]
    facts = [rounded(value) == value for value in floats]
    facts += [z3.Implies(one <= other, rounded(one) <= rounded(other))
              for one in floats + sums for other in floats + sums]
    facts += [change >= 0, cold <= hot, least <= ceiling_hot, ceiling_hot <= ceiling_cold, ceiling_cold <= most]

    def after(motor, ceiling):
        lower, higher = rounded(ceiling - change), rounded(ceiling + change)
        lower = z3.If(lower < least, least, lower)
        higher = z3.If(higher > most, most, higher)
        return z3.If(motor > maximum, least, z3.If(motor <= limit, higher, lower))
    return falsified(facts, z3.And(after(hot, ceiling_hot) <= after(cold, ceiling_cold),
                                   after(hot, ceiling_hot) >= least, after(cold, ceiling_cold) <= most))


def node_limiter(text):
    """NodeLimiter: a smaller margin of the nearest part never gives a higher ceiling, in floats."""
    require(text, "const float above_least = state_.margin_K * 254.0f / state_.band_K;",
            "state_.band_K = detail::at_least(2.0f * fastest_K_per_s_ * dt_s, config_.derating_K);",
            "above_least >= 254.0f ? 255 : static_cast<uint8_t>(above_least > 0.0f ? "
            "least_power() + static_cast<uint8_t>(above_least) : least_power());",
            "const float margin_K = config_.node[i].maximum_C - state_.node_C[i]; "
            "if (margin_K < state_.margin_K) {")
    # A product and a quotient rounded to nearest do not fall when the margin grows, nor when the band shrinks, which is no wider for
    # smaller rises: known of the two numbers, and of nothing else.
    near, far = z3.Reals("above_least_hot above_least_cold")
    whole = z3.ToInt
    ceiling = lambda v: z3.If(v >= 254, 255, z3.If(v > 0, 1 + whole(v), 1))
    return falsified([near <= far], z3.And(ceiling(near) <= ceiling(far), ceiling(near) >= 1))
