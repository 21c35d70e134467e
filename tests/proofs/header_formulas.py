# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Reads functions out of a header and turns them into Python that z3 can run, so that a proof is about the text
that is compiled and not about a copy of it.

Only what the certified limiter's functions consist of is understood: declarations, assignments, `if` with one
statement, conditional expressions, calls. Anything else is an error that names the statement.
"""
import re


class NotUnderstood(Exception):
    """A statement of another form than this reader knows."""


def body_of(text, signature):
    """The text between the braces of the one function whose head matches `signature`, without comments."""
    text = re.sub(r"//[^\n]*", "", text)
    found = [m for m in re.finditer(signature + r"[^;{}]*\{", text)]
    if len(found) != 1:
        raise NotUnderstood("%d functions match %r" % (len(found), signature))
    start, depth = found[0].end(), 1
    for at in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return text[start:at]
    raise NotUnderstood("no end of " + signature)


def split_top(text, separator):
    """Splits where `separator` stands outside of brackets."""
    parts, depth, last = [], 0, 0
    for at, sign in enumerate(text):
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(sign, 0)
        if depth == 0 and sign == separator:
            parts.append(text[last:at])
            last = at + 1
    return parts + [text[last:]]


def expression(text):
    """A C++ expression as a Python one."""
    text = " ".join(text.split())
    choice = split_top(text, "?")
    if len(choice) > 1:
        rest = "?".join(choice[1:])
        ends = split_top(rest, ":")
        return "ite(%s, %s, %s)" % (expression(choice[0]), expression(ends[0]), expression(":".join(ends[1:])))
    # A conditional expression within brackets.
    out, at = "", 0
    while at < len(text):
        if text[at] == "(":
            depth, end = 0, at
            while True:
                depth += {"(": 1, ")": -1}.get(text[end], 0)
                if depth == 0:
                    break
                end += 1
            arguments = [expression(a) for a in split_top(text[at + 1:end], ",")]
            out += "(" + ", ".join(arguments) + ")"
            at = end + 1
        else:
            out += text[at]
            at += 1
    return out


def prepared(text):
    text = re.sub(r"static_cast<[\w:]+>", "", text)
    text = text.replace("detail::", "").replace("this->", "self.").replace("CertifiedNode::", "CertifiedNode.")
    text = re.sub(r"\braise\(", "raise_(", text)
    text = re.sub(r"\b(0x[0-9a-f]+|\d+)[UuLl]+\b", r"\1", text)
    text = re.sub(r"(?<![\w.])(room|sizes|end_sizes|settled|supply|take|carry|rounding_units|slack_units|still_end|end_per_count)\(", r"self.\1(", text)
    return text


MEMBER = re.compile(r"(?<![\w.])([a-z]\w*_)(?=\W|$)(?!\()")
TYPE = r"(?:const\s+)?(?:KelvinUnits|UnitFraction|FineFraction|UpperBound|Hull|Room|Sizes|EndSizes|CertifiedCount|int32_t|uint32_t|uint8_t|uint16_t|auto)"


def statement(text):
    """Python lines of one C++ statement."""
    text = " ".join(text.split())
    if not text:
        return []
    conditional = re.match(r"if \(", text)
    if conditional:
        depth, end = 0, text.index("(")
        while True:
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            if depth == 0:
                break
            end += 1
        condition, rest = expression(text[4:end]), text[end + 1:].strip()
        assignment = re.match(r"([\w.]+) = (.*)$", rest)
        if not assignment:
            raise NotUnderstood(text)
        name = assignment.group(1)
        return ["%s = ite(%s, %s, %s)" % (name, condition, expression(assignment.group(2)), name)]
    declared = re.match(TYPE + r" (.*)$", text)
    if declared:
        lines = []
        for one in split_top(declared.group(1), ","):
            made = re.match(r"\s*(\w+) = \{(.*)\}$", one)
            if made:
                lines.append("%s = record(%s)" % (made.group(1), ", ".join(
                    expression(e) for e in split_top(made.group(2), ","))))
                continue
            made = re.match(r"\s*(\w+) = (.*)$", one)
            lines.append("%s = %s" % (made.group(1), expression(made.group(2))) if made
                         else "%s = blank()" % one.strip())
        return lines
    if text.startswith("return "):
        return ["return " + expression(text[7:])]
    assignment = re.match(r"([\w.]+) = (.*)$", text)
    if assignment:
        return ["%s = %s" % (assignment.group(1), expression(assignment.group(2)))]
    if re.match(r"[\w.]+\(.*\)$", text):
        return [expression(text)]
    raise NotUnderstood(text)


def function(text, signature, name, arguments, names):
    """The C++ function as a Python one over `names`. `self` is the object whose members end with `_`."""
    body = MEMBER.sub(r"self.\1", prepared(body_of(text, signature)))
    lines = []
    for one in split_top(body, ";"):
        lines += statement(one)
    source = "def %s(%s):\n" % (name, ", ".join(arguments)) + "".join("    %s\n" % line for line in lines)
    scope = dict(names)
    exec(compile(source, "<%s>" % name, "exec"), scope)
    scope[name].source = source
    return scope[name]
