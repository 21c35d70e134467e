#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""A page of docs/ from the form that a code host shows to the one that Doxygen knows: docs/Doxyfile.in calls it for each page.

    for_doxygen.py PAGE

| in the page | for Doxygen |
| `# Title`, next line `<!-- page NAME -->` | `# Title {#NAME}` |
| `<a id="NAME"></a>` before a heading | the heading with `{#NAME}` |
| `[words](other.md)`, `[words](other.md#NAME)` | `@ref NAME "words"` |
| `[words](../../include/... "thermopower::Name")` | `@ref thermopower::Name "words"` |
| `<!-- snippet FILE PART -->` and the fenced block after it | `@snippet FILE PART` |
| `![words](../figures/FILE)` | `@image html FILE "words"` |
| `<!-- subpage NAME --> words`, `<!-- htmlinclude FILE -->` | `@subpage NAME`, `@htmlinclude FILE` |
| ``$`formula`$`` and a fenced block of math | formulas of Doxygen |
"""

import os
import re
import sys


def name_of(path):
    """The name that a page has for Doxygen."""
    with open(path, encoding="utf-8") as file:
        found = re.search(r"^<!-- page (\w+) -->$", file.read(), re.M)
    if not found:
        sys.exit(f"for_doxygen.py: {path} does not say its name in a line <!-- page NAME -->")
    return found.group(1)


def links_in(line, folder):
    def link(match):
        if match.group(0).startswith("`"):  # what is code stays as it is
            return match.group(0)
        words, target, title = match.group(1), match.group(2), match.group(3)
        if title:
            return f'@ref {title.replace("group ", "")} "{words.replace(chr(96), "")}"'
        page, _, part = target.partition("#")
        if not page.endswith(".md") or "://" in page:
            return match.group(0)
        path = os.path.normpath(os.path.join(folder, page))
        if os.sep + "docs" + os.sep not in path:
            return match.group(0)
        return f'@ref {part or name_of(path)} "{words}"'

    return re.sub(r'(?<!!)\[([^\]]*)\]\(([^) ]+)(?: "([^"]*)")?\)|`[^`]*`', link, line)


def converted(text, folder):
    lines, out, number = text.split("\n"), [], 0
    while number < len(lines):
        line = lines[number]
        number += 1
        following = lines[number] if number < len(lines) else ""
        if re.match(r"^# ", line) and (page := re.match(r"^<!-- page (\w+) -->$", following)):
            out += [f"{line} {{#{page.group(1)}}}", ""]
            number += 1
        elif anchor := re.match(r'^<a id="(\w+)"></a>$', line):
            out += [f"{following} {{#{anchor.group(1)}}}"]
            number += 1
        elif part := re.match(r"^( *)<!-- snippet (\S+) (.*) -->$", line):
            out.append(f"{part.group(1)}@snippet {part.group(2)} {part.group(3)}")
            while not lines[number].strip().startswith("```"):
                number += 1
            number += 1
            while lines[number].strip() != "```":
                number += 1
            number += 1
        elif formula := re.match(r"^( *)```math$", line):
            out.append(formula.group(1) + r"\f[")
            while lines[number].strip() != "```":
                out.append(lines[number])
                number += 1
            out.append(formula.group(1) + r"\f]")
            number += 1
        elif re.match(r"^ *```", line):
            out.append(line)
            while lines[number].strip() != "```":
                out.append(lines[number])
                number += 1
            out.append(lines[number])
            number += 1
        elif image := re.match(r"^( *)!\[(.*)\]\((?:\S*/)?([^/)]+)\)$", line):
            out.append(f'{image.group(1)}@image html {image.group(3)} "{image.group(2)}" width=95%')
        elif include := re.match(r"^<!-- htmlinclude (\S+) -->$", line):
            out.append(f"@htmlinclude {include.group(1)}")
        else:
            line = re.sub(r"<!-- subpage (\w+) --> \*\*[^*]*\*\*", r"@subpage \1", line)
            line = re.sub(r"<!-- subpage (\w+) --> \[([^\]]*)\]\([^)]*\)", r'@subpage \1 "\2"', line)
            line = links_in(line, folder)
            out.append(re.sub(r"\$`([^`]*)`\$", r"\\f$\1\\f$", line))
    return "\n".join(out)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as page:
        sys.stdout.write(converted(page.read(), os.path.dirname(os.path.abspath(sys.argv[1]))))
