# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Linear expressions whose products with a fraction 0 .. 1 are variables of their own.

What is known of a product is stated for every pair of products with the same fraction, so that a proof needs linear
arithmetic alone, which z3 decides at once. Knowing less than multiplication says can only make a proof fail, never
succeed wrongly.
"""
import z3


class Linear:
    """A constant and multiples of variables."""

    def __init__(self, terms=None, constant=0):
        self.terms = {name: factor for name, factor in (terms or {}).items() if factor != 0}
        self.constant = constant

    @staticmethod
    def of(value):
        return value if isinstance(value, Linear) else Linear({}, value)

    def plus(self, other, factor):
        other = Linear.of(other)
        terms = dict(self.terms)
        for name, one in other.terms.items():
            terms[name] = terms.get(name, 0) + factor * one
        return Linear(terms, self.constant + factor * other.constant)

    def times(self, factor):
        return Linear({name: factor * one for name, one in self.terms.items()}, factor * self.constant)

    def __add__(self, other):
        return self.plus(other, 1)

    __radd__ = __add__

    def __sub__(self, other):
        return self.plus(other, -1)

    def __rsub__(self, other):
        return Linear.of(other).plus(self, -1)

    def __neg__(self):
        return self.times(-1)

    def __rshift__(self, bits):
        """Any number: nothing is known of it where only the whole is asked for."""
        return Linear({"shifted": 1})

    def z3(self):
        return z3.Sum([z3.RealVal(0)] + [one * z3.Real(name) for name, one in self.terms.items()]) + self.constant

    def __le__(self, other):
        return self.z3() <= Linear.of(other).z3()

    def __lt__(self, other):
        return self.z3() < Linear.of(other).z3()

    def __ge__(self, other):
        return self.z3() >= Linear.of(other).z3()

    def __gt__(self, other):
        return self.z3() > Linear.of(other).z3()

    def same(self, other):
        return self.z3() == Linear.of(other).z3()

    def single(self):
        """The name of the one variable that this is."""
        (name, factor), = self.terms.items()
        assert factor == 1 and self.constant == 0
        return name


class Facts:
    """What is known: linear facts, and the products so far."""

    def __init__(self):
        self.known = []
        self.products = {}   # fraction -> [(argument, product)]
        self.larger = {}     # fraction -> a fraction that is not below it
        self.made = 0

    def add(self, *facts):
        self.known += facts

    def variable(self, name):
        return Linear({name: 1})

    def fresh(self, name):
        self.made += 1
        return self.variable("%s_%d" % (name, self.made))

    def fraction(self, name, at_most=None):
        """A variable 0 .. 1 that may be a factor."""
        fraction = self.variable(name)
        self.add(fraction >= 0, fraction <= 1)
        if at_most is not None:
            self.larger[name] = at_most
            self.add(fraction <= at_most)
        return fraction

    def choice(self, condition, yes, no):
        chosen = self.fresh("chosen")
        self.add(z3.Implies(condition, chosen.same(yes)), z3.Implies(z3.Not(condition), chosen.same(no)))
        return chosen

    def product(self, argument, fraction):
        """argument * fraction."""
        argument, name = Linear.of(argument), fraction.single()
        made = Linear({"%s*%s" % (name, one): factor for one, factor in argument.terms.items()})
        made = made + fraction.times(argument.constant)
        before = self.products.setdefault(name, [(Linear(), Linear())])
        # 0 <= a - b gives 0 <= f a - f b <= a - b; with b = 0 among them.
        for other, other_made in before:
            apart, part = argument - other, made - other_made
            self.add(z3.Implies(apart >= 0, z3.And(part >= 0, part <= apart)),
                     z3.Implies(apart <= 0, z3.And(part <= 0, part >= apart)))
        before.append((argument, made))
        if name in self.larger:
            more = self.product(argument, self.larger[name])
            self.add(z3.Implies(argument >= 0, made <= more), z3.Implies(argument <= 0, made >= more))
        return made

    def counterexample(self, goal, seconds=60):
        """None when the goal follows, else a state in which it fails. Undecided is an error."""
        solver = z3.Solver()
        solver.set("timeout", 1000 * seconds)
        solver.add(*self.known)
        solver.add(z3.Not(goal))
        found = solver.check()
        if found == z3.unknown:
            raise RuntimeError("z3 could not decide: " + solver.reason_unknown())
        return None if found == z3.unsat else solver.model()
