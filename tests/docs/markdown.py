#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""The pages as a code host shows them: code, and links that lead somewhere.

    markdown.py check ROOT    each block of code is the part of the compiled source that it names, each other one stands in one, each link leads to a file and to a
                              heading or a name in it, and no command of Doxygen is left for readers to see
    markdown.py write ROOT    takes the blocks of code from the sources anew
"""

import os
import re
import sys

from prose import pages

SOURCES = ("examples", "tests/docs/examples", "tools/web", "tools/docs-search")


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def part_of_source(root, source, part):
    """Lines of the part of a source between two comments `[part]`, and what is wrong."""
    found = [os.path.join(folder, name) for top in SOURCES for folder, _, names in os.walk(os.path.join(root, top)) for name in names
             if os.path.join(folder, name).endswith("/" + source)]
    if len(found) != 1:
        return [], f"{len(found)} sources are called {source}"
    lines = read("", found[0]).split("\n")
    marks = [number for number, line in enumerate(lines) if f"[{part}]" in line]
    if len(marks) != 2:
        return [], f"{source} has no part [{part}]"
    body = lines[marks[0] + 1:marks[1]]
    margin = min((len(line) - len(line.lstrip()) for line in body if line.strip()), default=0)
    return [line[margin:] for line in body], None


def with_code(root, text, wrong):
    """The page with its blocks of code as the sources have them."""
    def block(match):
        margin, source, part = match.group(1), match.group(2), match.group(3)
        lines, what = part_of_source(root, source, part)
        if what:
            wrong.append(what)
            return match.group(0)
        body = "\n".join((margin + line).rstrip() for line in lines)
        return f"{margin}<!-- snippet {source} {part} -->\n{margin}```cpp\n{body}\n{margin}```"

    return re.sub(r"^( *)<!-- snippet (\S+) (.+?) -->\n *```cpp\n(?:.*?\n)??\1```$", block, text, flags=re.M | re.S)


def compiled_sources(root):
    """Each compiled source as lines without margins."""
    for top in (*SOURCES, "tests/readme"):
        for folder, _, names in os.walk(os.path.join(root, top)):
            for name in names:
                if name.endswith((".cpp", ".hpp", ".h", ".ino")):
                    yield "\n".join(line.strip() for line in read("", os.path.join(folder, name)).split("\n") if line.strip())


def code_of_nowhere(root, page, text):
    """Blocks of C++ that name no source: they have to stand in one all the same, line by line."""
    blocks = [block for before, block in re.findall(r"^(.*)\n *```(?:cpp|c\+\+|c|h|ino|arduino)\n((?:.*\n)*?) *```$", text, re.M)
              if "<!-- snippet" not in before]
    if blocks:
        sources = list(compiled_sources(root))
        for block in blocks:
            lines = "\n".join(line.strip() for line in block.split("\n") if line.strip())
            if not any(lines in source for source in sources):
                yield f"{page}: no compiled source has the code that begins with '{lines.splitlines()[0]}'"


def without_code(text):
    text = re.sub(r"^( *)```.*?^\1```$", "", text, flags=re.M | re.S)
    text = re.sub(r"\$`[^`]*`\$", "", text)
    return re.sub(r"^(?: {4,}(?!- |\d)\S.*|.*///.*)$", "", text, flags=re.M)


def slugs(text):
    """What headings are called in addresses."""
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
    yield from re.findall(r'<a id="(\w+)"></a>', text)


def wrong_links(root, page, text):
    for words, target, title in re.findall(r'\[([^\]\n]*)\]\(([^)\s]+)(?: "([^"]*)")?\)', without_code(text)):
        if "://" in target:
            continue
        path, _, heading = target.partition("#")
        there = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(os.path.join(root, there)):
            yield f"{page}: [{words}] leads to {target}, which is not there"
        elif heading and heading not in slugs(read(root, there)):
            yield f"{page}: [{words}] leads to {target}; there is no such heading"
        elif title.startswith("thermopower::") and not re.search(rf"\b{title.split('::')[-1]}\b", read(root, there)):
            yield f"{page}: [{words}] says {title}; {there} does not name it"


def examine(root, page, write=False):
    text, wrong = read(root, page), []
    anew = with_code(root, text, wrong)
    wrong = [f"{page}: {one}" for one in wrong]
    if anew != text and write:
        with open(os.path.join(root, page), "w", encoding="utf-8") as file:
            file.write(anew)
        text = anew
    if anew != text:
        wrong.append(f"{page}: a block of code is not what its source has; 'python3 tests/docs/markdown.py write .' takes it from there")
    prose = re.sub(r"`[^`\n]*`", "", without_code(text))
    wrong += [f"{page}: {one} is a command of Doxygen, which readers of a code host see" for one in
              re.findall(r"(?<![\w.])@(?:ref|snippet|subpage|image|htmlinclude|note|warning)\b|\{#\w+\}|\\f[$\[]", prose)]
    if page.startswith("docs/") and page != "docs/index.md" and not re.match(r"# .*\n<!-- page \w+ -->\n", text):
        wrong.append(f"{page}: expected a title and then <!-- page NAME -->, the name that doc comments link to")
    return wrong + list(code_of_nowhere(root, page, text)) + list(wrong_links(root, page, text))


def main():
    if len(sys.argv) != 3 or sys.argv[1] not in ("check", "write"):
        sys.exit(__doc__)
    wrong, blocks = [], 0
    for page in pages(sys.argv[2]):
        wrong += examine(sys.argv[2], page, sys.argv[1] == "write")
        blocks += len(re.findall(r"^ *<!-- snippet ", read(sys.argv[2], page), re.M))
    print("\n".join(wrong))
    print(f"{blocks} blocks of code, {len(wrong)} faults")
    sys.exit(1 if wrong or blocks < 20 else 0)


if __name__ == "__main__":
    main()
