# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""From the actuator to the two scalar equations that the step carries: polynomial inequalities over real numbers,
for every admitted parameter. The numbers in brackets are those of docs/explain/certified-limiter.md."""
import z3


def falsified(facts, goal, seconds=60):
    """None when the goal follows from the facts."""
    solver = z3.Tactic("qfnra-nlsat").solver()
    solver.set("timeout", 1000 * seconds)
    solver.add(*facts)
    solver.add(z3.Not(goal))
    found = solver.check()
    if found == z3.unknown:
        raise RuntimeError("z3 could not decide: " + solver.reason_unknown())
    return None if found == z3.unsat else solver.model()


class Actuator:
    """Any actuator within its bounds: (1) and (2), without divisions."""

    def __init__(self):
        (self.c_w, self.c_b, self.k, self.g, self.power, self.t_w, self.t_b, self.air) = z3.Reals(
            "C_w C_b K G P T_w T_b T_air")
        self.facts = [self.c_w > 0, self.c_b > 0, self.k > 0, self.g > 0, self.power >= 0]
        self.into_winding = self.power - self.k * (self.t_w - self.t_b)
        self.into_body = self.k * (self.t_w - self.t_b) - self.g * (self.t_b - self.air)


def cooperative():
    """(4): more heat, warmer air or a warmer neighbour never makes a node's heat flow smaller."""
    cold, hot = Actuator(), Actuator()
    power, air, winding, body = z3.Reals("P' T_air' T_w' T_b'")
    warmer = cold.facts + [power >= cold.power, air >= cold.air, winding >= cold.t_w, body >= cold.t_b]
    hot.power, hot.air, hot.t_w, hot.t_b = power, air, winding, body
    winding_flow = power - cold.k * (cold.t_w - body)       # at the winding's own temperature
    body_flow = cold.k * (winding - cold.t_b) - cold.g * (cold.t_b - air)
    return falsified(warmer, z3.And(winding_flow >= cold.into_winding, body_flow >= cold.into_body))


def winding_stays_warmer():
    """(8), (9): where winding and body meet, or body and air, the warmer one does not become the colder."""
    a = Actuator()
    meet = falsified(a.facts + [a.t_w == a.t_b, a.t_b >= a.air],
                     a.into_winding * a.c_b >= a.into_body * a.c_w)
    return meet or falsified(a.facts + [a.t_b == a.air, a.t_w >= a.t_b], a.into_body >= 0)


def body_below_mean():
    """(10): with the winding not colder, the body is not above the mean, and without power the mean does not rise."""
    a = Actuator()
    m = z3.Real("m")
    facts = a.facts + [m * (a.c_w + a.c_b) == a.c_w * a.t_w + a.c_b * a.t_b, a.t_w >= a.t_b, a.t_b >= a.air]
    return falsified(facts, z3.And(a.t_b <= m, m <= a.t_w)) or falsified(
        facts + [a.power == 0], a.into_winding + a.into_body <= 0)


def winding_equation(least_coupling=True):
    """(18): the winding's own equation stays below the scalar one that is carried, at any coupling not below the
    declared and any heat capacities within theirs. `share` is 1 - mu."""
    a = Actuator()
    w_low, w_high, b_high, k_low, share, share_high, m, mean, power, end = z3.Reals(
        "C_w_low C_w_high C_b_high K_low share share_high m mean P_most end")
    facts = a.facts + [
        0 < w_low, w_low <= a.c_w, a.c_w <= w_high, a.c_b <= b_high, 0 < k_low,
        share * (a.c_w + a.c_b) == a.c_b, share_high * (w_low + b_high) == b_high,
        a.power <= power, m <= mean, m <= a.t_w, 0 < share, share < 1, 0 < share_high, share_high < 1,
        # T_w - T_b = (T_w - m) / share; end = mean + P share_high / K_low
        (a.t_w - a.t_b) * share == a.t_w - m, (end - mean) * k_low == power * share_high]
    if least_coupling:
        facts.append(k_low <= a.k)
    if falsified(facts, share <= share_high) is not None:
        return "share"
    # C_w T_w' <= K_low / share_high (end - T_w): with it, dividing by C_w, the rate is the fastest on the way up and
    # the slowest on the way down. Three steps, each of few variables.
    flow, apart = z3.Reals("flow apart")
    step_1 = falsified([apart >= 0, k_low > 0] + ([a.k >= k_low] if least_coupling else [a.k > 0]),
                       a.power - a.k * apart <= a.power - k_low * apart)
    over = z3.Real("over_mean")  # T_w - m >= 0
    step_2 = falsified([over >= 0, 0 < share, share <= share_high, k_low > 0, apart * share == over],
                       k_low * apart * share_high >= k_low * over)
    step_3 = falsified(
        [k_low > 0, share_high > 0, a.power <= power, over + m == a.t_w, m <= mean,
         apart * share_high >= over, (end - mean) * k_low == power * share_high],
        (a.power - k_low * apart) * share_high <= k_low * (end - a.t_w))
    rate = falsified([w_low > 0, w_low <= a.c_w, a.c_w <= w_high, apart >= 0],
                     z3.And(apart * w_low <= apart * a.c_w, -apart * w_high <= -apart * a.c_w))
    for found in (step_1, step_2, step_3, rate):
        if found is not None:
            return found
    return None


def mean_equation(raised=True):
    """(20): the mean's equation stays below the scalar one, with the winding at its bound, when the bounds were raised
    by (13). The heat is that of the least power, which `base` stands for (11), and of the count."""
    base, air, mean, winding, share, share_low, g, g_low, least_power, counted, t_b, t_w = z3.Reals(
        "base T_air m w share share_low G G_low P_1 P_n T_b T_w")
    facts = [0 < share_low, share_low <= share, share <= 1, 0 < g_low, g_low <= g, least_power >= 0, counted >= 0,
             (base - air) * g_low == least_power, t_w <= winding, mean <= winding, t_w >= mean]
    if raised:
        facts.append(mean - base >= (1 - share_low) * (winding - base))
    # m = (1 - share) T_w + share T_b at its bound.
    facts.append(share * t_b == mean - (1 - share) * t_w)
    lowest_body = z3.Real("lowest T_b")
    facts.append(share_low * lowest_body == mean - (1 - share_low) * winding)
    first = falsified(facts, t_b >= lowest_body)
    if first is not None:
        return first
    second = falsified(facts[:8] + ([lowest_body >= base] if raised else []) + [t_b >= lowest_body],
                       least_power + counted - g * (t_b - air) <= counted - g_low * (lowest_body - base))
    if second is not None:
        return second
    # lowest T_b >= base is (13) itself.
    return falsified(facts, lowest_body >= base)


def lead_equation(most_coupling=True):
    """(37), (38): the winding's lead over the mean falls no faster than the lower bound that is carried, at any coupling
    not above the declared, any capacities, and any conductance. `share` is 1 - mu."""
    a = Actuator()
    share, share_low, k_high, least_power, least_share, share_of_end = z3.Reals(
        "share share_low K_high P_least apart_at_share_low E")
    apart = a.t_w - a.t_b
    # C_w times the lead's rate, (1 - mu)(T_w' - T_b'), from (1) and (2): this is (37).
    facts = a.facts + [share * (a.c_w + a.c_b) == a.c_b]
    rate = share * (a.into_winding * a.c_b - a.into_body * a.c_w)  # times C_b
    identity = falsified(
        facts, rate == a.c_b * (share * a.power - a.k * apart + (1 - share) * a.g * (a.t_b - a.air)))
    if identity is not None:
        return identity
    over, power, k, d, cooling = z3.Reals("lead P K T_w-T_b mu*G*(T_b-T_air)")
    bounds = [0 < share_low, share_low <= share, share < 1, over >= 0, share * d == over, share_low * least_share == over,
              k >= 0, 0 < k_high, 0 <= least_power, least_power <= power, cooling >= 0,
              share_of_end * k_high == share_low * share_low * least_power]
    if most_coupling:
        bounds.append(k <= k_high)
    # K_high / share_low (E - lead), multiplied out.
    found = falsified(bounds, share * power - k * d + cooling >= share_low * least_power - k_high * least_share)
    return found or falsified([0 < share_low, share_low * least_share == over, 0 < k_high,
                               share_of_end * k_high == share_low * share_low * least_power],
                              share_low * (share_low * least_power - k_high * least_share)
                              == k_high * (share_of_end - over))


def two_ends(at_both=True):
    """(39) to (41): between two winding temperatures the mean's rate is not above the larger of those at the ends, and
    the one line that is carried lies above both lines."""
    x, y, part, heat_x, heat_y, heat, slope, rise = z3.Reals("T_cool T_warm part q_cool q_warm q slope rho")
    between = x + part * (y - x)
    convex = falsified(
        [0 <= x, x <= y, 0 <= part, part <= 1, rise >= 0, heat_x * (1 + rise * x) == 1, heat_y * (1 + rise * y) == 1,
         heat * (1 + rise * between) == 1],
        heat <= (1 - part) * heat_x + part * heat_y)
    if convex is not None:
        return convex
    # A mixture of two values is not above the larger; what is linear in the lead mixes in the same proportion.
    rate_x, rate_y, larger = z3.Reals("F_cool F_warm larger")
    ends = [larger >= rate_x] + ([larger >= rate_y] if at_both else [])
    mixed = falsified(ends + [0 <= part, part <= 1], (1 - part) * rate_x + part * rate_y <= larger)
    if mixed is not None:
        return mixed
    cool, warm, way, above, sigma = z3.Reals("v_cool v_warm v m-m_0 sigma")
    facts = [way >= cool, way >= warm, 0 < sigma, sigma <= 1]
    return falsified(facts + [above >= 0], z3.And(cool - sigma * above <= way - sigma * above,
                                                  warm - above <= way - sigma * above)) or falsified(
        facts + [above <= 0], z3.And(cool - sigma * above <= way - above, warm - above <= way - above))


def travel_fractions(third="6"):
    """CertifiedTravel: F = x - x^2/2 + x^3/6 has F' >= 1 - F and F(0) = 0, so F >= 1 - exp(-x) by the same comparison;
    x - x^2/2 has F' <= 1 - F."""
    x = z3.Real("x")
    third = z3.RealVal(third)
    above, above_rate = x - x * x / 2 + x * x * x / third, 1 - x + 3 * x * x / third
    below, below_rate = x - x * x / 2, 1 - x
    return falsified([x >= 0], above_rate >= 1 - above) or falsified([x >= 0], below_rate <= 1 - below)


def whole_margin():
    """A hold of many time constants ends at 1 - 2^-16 instead of one: the heat, which is declared with a margin of
    2^-15 and used with a fraction that stands for a whole, makes up for it."""
    heat, over, true_part = z3.Reals("declared over part")
    whole = 1 - z3.RealVal(1) / 65536
    # float_margin() is in the heat as well; half of it is asked for here.
    used = heat * (1 + z3.RealVal(1) / 32768) * (1 + z3.RealVal(1) / 524288) * whole
    return falsified([heat >= 0, over >= 0, 0 <= true_part, true_part <= 1, used >= over, heat >= over],
                     true_part * (heat - over) <= whole * (used - over))
