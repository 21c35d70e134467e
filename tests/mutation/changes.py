# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Every change of one place in a header that could be a mistake: what mutation.py tries.

A header is read as tokens, no compiler is needed: comments, strings, preprocessor lines, static_assert, typedef and using are
left alone. clang-format puts a space on both sides of a binary operator, which tells `a < b` from `Type<b>` and `a * b` from `Type* b`.
A change that means nothing does not compile, and costs a moment.
"""
import re

TOKEN = re.compile(r"""(?P<skip>//[^\n]*|/\*.*?\*/|\s+|^[ \t]*\#(?:[^\n\\]|\\.)*)
                     |(?P<text>"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')
                     |(?P<number>0[xX][0-9a-fA-F]+[uUlL]*|(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?[uUlLfF]*)
                     |(?P<word>[A-Za-z_]\w*)
                     |(?P<sign><<=|>>=|\.\.\.|->|::|\+\+|--|&&|\|\||[-+*/%&|^<>=!]=|<<|>>|.)""",
                   re.X | re.S | re.M)
BINARY = {"<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"], "==": ["!="], "!=": ["=="], "&&": ["||"], "||": ["&&"],
          "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["*"], "&": ["|"], "|": ["&"], "^": ["|"], "<<": [">>"], ">>": ["<<"],
          "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="], "|=": ["&="], "&=": ["|="], "^=": ["|="], "<<=": [">>="], ">>=": ["<<="]}
OPENS, CLOSES = {"(": ")", "[": "]", "{": "}"}, {")", "]", "}"}
LEFT_ALONE = {"static_assert", "typedef", "using"}
DECLARATION = re.compile(r"(?:[\w:]+(?:<.*?>)?[&*]*\s+)+[&*]*\w+\s*(?:[=;({\[]|$)", re.S)
NO_EXPRESSION = {"if", "for", "while", "do", "else", "switch", "case", "default", "const", "constexpr", "static", "public", "private",
                 "protected", "struct", "class", "enum", "template", "goto", "delete", "throw", "inline", "explicit", "typename"}


class Token:
    def __init__(self, kind, text, at):
        self.kind, self.text, self.at, self.end = kind, text, at, at + len(text)


class Change:
    """Characters [at, end) of a header become `new`; `what` names the kind."""

    def __init__(self, at, end, new, what):
        self.at, self.end, self.new, self.what = at, end, new, what

    def applied(self, header):
        return header[:self.at] + self.new + header[self.end:]


class Header:
    def __init__(self, header):
        self.header = header
        self.tokens = [Token(m.lastgroup, m.group(), m.start()) for m in TOKEN.finditer(header) if m.lastgroup != "skip"]
        self.partner = self.match()
        self.alone = self.left_alone()
        self.found = []
        self.bodies = []   # of functions, from brace to brace
        self.members = []  # constants that members begin with

    def match(self):
        partner, stack = {}, []
        for i, token in enumerate(self.tokens):
            if token.text in OPENS:
                stack.append(i)
            elif token.text in CLOSES and stack:
                partner[i] = stack.pop()
                partner[partner[i]] = i
        return partner

    def text(self, i):
        return self.tokens[i].text if 0 <= i < len(self.tokens) else ""

    def end_of_statement(self, i):
        while i < len(self.tokens) and self.text(i) != ";":
            if self.text(i) in CLOSES:
                return None
            i = self.partner.get(i, i) + 1
        return i if i < len(self.tokens) else None

    def left_alone(self):
        alone = set()
        for i, token in enumerate(self.tokens):
            end = i
            if token.text in LEFT_ALONE:
                end = self.end_of_statement(i) or i
            elif token.text == "[" and self.text(i + 1) == "[":
                end = self.partner.get(i, i)
            elif token.text == "operator":
                end = i + 1
            if end > i:
                alone.update(range(i, end + 1))
        return alone

    def add(self, first, last, new, what):
        change = Change(self.tokens[first].at, self.tokens[last].end, new, what)
        if self.header[change.at:change.end] != new:
            self.found.append(change)

    def is_binary(self, i):
        token = self.tokens[i]
        return self.header[token.at - 1].isspace() and self.header[token.end:token.end + 1].isspace() and self.text(i - 1) != "template"

    def number(self, i):
        text = self.text(i)
        if re.search(r"[.]|[eE]", text) and not text.startswith(("0x", "0X")):
            suffix = "f" if text.endswith(("f", "F")) else ""
            if float(text.rstrip("fFlL")) == 0.0:
                self.add(i, i, "1.0" + suffix, "constant")
                self.add(i, i, "(-1.0%s)" % suffix, "constant")
            else:
                self.add(i, i, "(%s * 1.01%s)" % (text, suffix), "constant")
                self.add(i, i, "(%s * 0.99%s)" % (text, suffix), "constant")
        elif int(text.rstrip("uUlL"), 0) == 0:
            self.add(i, i, "1", "constant")
        else:
            self.add(i, i, "(%s + 1)" % text, "constant")
            self.add(i, i, "(%s - 1)" % text, "constant")

    def operators_and_constants(self):
        for i, token in enumerate(self.tokens):
            if i in self.alone:
                continue
            if token.kind == "number":
                self.number(i)
            elif token.text in ("true", "false"):
                self.add(i, i, "false" if token.text == "true" else "true", "constant")
            elif token.kind != "sign":
                continue
            elif token.text in ("++", "--"):
                self.add(i, i, "--" if token.text == "++" else "++", "arithmetic")
            elif token.text in BINARY and self.is_binary(i):
                for new in BINARY[token.text]:
                    self.add(i, i, new, "operator")
            elif token.text in ("!", "~") or token.text == "-" and not self.is_binary(i):
                self.add(i, i, "", "sign removed")

    def conditions(self):
        for i, token in enumerate(self.tokens):
            if i in self.alone:
                continue
            if token.text in ("if", "while") and self.text(i + 1) == "(":
                last = self.partner[i + 1]
                condition = self.header[self.tokens[i + 1].end:self.tokens[last].at]
                if not DECLARATION.match(condition):
                    for new in ("true", "false") if token.text == "if" else ("false",):
                        self.add(i + 1, last, "(%s)" % new, "condition")
            elif token.text == "?":
                first = i - 1
                while first >= 0 and self.text(first) not in {"return", ",", ";", ":", "?", "=", "+=", "-=", "(", "[", "{", "}"}:
                    first = self.partner[first] - 1 if self.text(first) in CLOSES else first - 1
                for new in ("true", "false"):
                    self.add(first + 1, i - 1, new, "condition")

    def is_code(self, i, within):
        """Is the brace at i a block of statements? `within`: what the brace around it is."""
        before = self.text(i - 1)
        if before in (")", "noexcept", "else", "do", "override") or before == "const" and self.text(i - 2) == ")":
            return True
        return within == "code" and before in (";", "{", "}", ":")

    def is_constant(self, i):
        """Does the compiler want to know the value of the function or member that ends before token i?"""
        while i > 0 and self.text(i - 1) not in (";", "}", "{"):
            i -= 1
            if self.text(i) in ("constexpr", "static_assert"):
                return True
        return False

    def statements(self):
        stack = ["outside"]
        starts = set()
        for i, token in enumerate(self.tokens):
            if token.text == "{":
                kind = "code" if self.is_code(i, stack[-1]) else "other"
                if kind == "code" and stack[-1] != "code" and not self.is_constant(i):
                    self.bodies.append((token.at, self.tokens[self.partner[i]].end))
                stack.append(kind)
            elif token.text == "}" and len(stack) > 1:
                stack.pop()
            if stack[-1] == "code" and (token.text in ("{", "}", ";", "else", "do") or
                                        token.text == ")" and self.text(self.partner[i] - 1) in ("if", "for", "while", "switch")):
                starts.add(i + 1)
            if stack[-1] != "code" and token.text == ":" and self.text(i - 1) in (")", "noexcept"):
                self.initialisers(i + 1)
            constant = token.kind == "number" or token.text in ("true", "false")
            if stack[-1] == "other" and constant and self.text(i - 1) == "=" and self.text(i + 1) == ";" and not self.is_constant(i):
                self.members.append((token.at, token.end))
        # What stands in the parentheses of `for` is no statement.
        for i, token in enumerate(self.tokens):
            if token.text == "for" and self.text(i + 1) == "(":
                starts -= set(range(i + 2, self.partner[i + 1] + 1))
        for i in sorted(starts - self.alone):
            self.statement(i)

    def statement(self, i):
        last = self.end_of_statement(i)
        first = self.text(i)
        if last is None or last == i or first == "{":
            return
        whole = self.header[self.tokens[i].at:self.tokens[last].end]
        if first in ("break", "continue") or first == "return" and last == i + 1:
            self.add(i, last, ";", "statement")
        elif first == "return":
            value = self.header[self.tokens[i + 1].at:self.tokens[last - 1].end]
            if value not in ("false", "true", "0", "0.0f", "nullptr", "{}"):
                self.add(i, last, "return {};", "value returned")
            if re.match(r"\w[\w:]*\(", value):
                self.add(i, last, "return;", "statement")
        elif first not in NO_EXPRESSION and not DECLARATION.match(whole):
            self.add(i, last, ";", "statement")

    def initialisers(self, i):
        while self.tokens[i].kind == "word" and i + 1 < len(self.tokens):
            while self.text(i + 1) in ("::",) or self.tokens[i + 1].kind == "word":
                i += 1
            if self.text(i + 1) not in ("(", "{"):
                return
            end = self.partner[i + 1]
            if end > i + 2:
                self.add(i + 1, end, "()", "initialiser")
            if self.text(end + 1) != ",":
                return
            i = end + 2

    def changes(self):
        self.operators_and_constants()
        self.conditions()
        self.statements()
        return sorted({(c.at, c.end, c.new): c for c in self.found}.values(), key=lambda c: (c.at, c.end, c.new))


def changes(header):
    return Header(header).changes()


def all_in_one(header, numbered):
    """The header with every numbered change in the body of a function or of what a member begins with, chosen by ::mutation_number.

    Gives the text, of each of its lines the number of the change that it belongs to, and the numbers. A constexpr
    function, a constant of a type and a constructor's initialiser stay as they are.
    """
    parsed = Header(header)
    parsed.changes()
    text, owner, held, done = "", {}, [], 0

    def put(more, number=None):
        nonlocal text
        first = text.count("\n") + 1
        text += more
        if number is not None:
            owner.update({line: number for line in range(first, text.count("\n") + 1)})

    start = re.search(r"^#pragma once\n", header, re.M).end()
    put(header[:start] + "extern int mutation_number;\n")
    done = start
    parts = parsed.bodies + [place for place in parsed.members if any(place == (change.at, change.end) for _, change in numbered)]
    for first, last in sorted(parts):
        if (first, last) in parsed.members:
            put(header[done:first])
            values = [(number, change.new) for number, change in numbered if (change.at, change.end) == (first, last)]
            choice = "".join("::mutation_number == %d ? (%s) : " % value for value in values)
            held += [number for number, _ in values]
            put("(%s%s)" % (choice, header[first:last]), values[0][0])
            done = last
            continue
        within = [(number, change) for number, change in numbered if first < change.at and change.end < last]
        if not within:
            continue
        put(header[done:first] + "{ switch (::mutation_number) {\n")
        for number, change in within:
            put("case %d: %s break;\n" % (number, header[first:change.at] + change.new + header[change.end:last]), number)
            held.append(number)
        put("default: " + header[first:last] + "}}")
        done = last
    put(header[done:])
    return text, owner, held
