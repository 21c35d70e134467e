#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Plain English on the pages: few long sentences, and none of the phrases that make readers decode.

    prose.py check ROOT          README.md, CONTRIBUTING.md and docs/: at most 3 % of all sentences are longer than 25 words, at most
                                 10 % of one page, and no phrase of the list below is used; prints each that is, with file and line
    prose.py words ROOT          the words of prose, page by page
    prose.py comments ROOT       the long sentences of the comments in include/, file by file, and their share; never fails
    prose.py test                the check notices a bad sample, sentence by sentence, and passes a good one

Prose is what is no code, table, formula, heading, link target or HTML.
"""

import os
import re
import sys

MOST_WORDS = 25
MOST_LONG, MOST_LONG_OF_A_PAGE = 0.03, 0.10

# Each phrase with what to write instead. A pattern is matched against one sentence.
PHRASES = (
    (r"^What\b(?!.*\?$)", "begin with the subject, not with 'What ...'"),
    (r"^Whoever\b", "say who it is: 'If you ...'"),
    (r"\b(?:is|are|was|were) no (?!longer\b|more\b|less\b|other\b|better\b|worse\b|larger\b|smaller\b|one\b)\w+", "'is not a ...', or 'there is no ...'"),
    (r"\bthat is no (?!longer\b|more\b|less\b)\w+", "'that is not a ...'"),
    (r"\bbut for\b", "'except for'"),
    (r"\bwhere (?:nothing|nobody|none)\b", "say the condition: 'if no ...'"),
    (r"\bnobody cares\b", "say the threshold"),
    (r"\bfor ever\b", "'permanently', or a time"),
    (r"\bof one's own\b", "'your own'"),
    (r"\ball the same\b", "'nevertheless', or leave it out"),
)
THERE_IS = re.compile(r"\b[Tt]here (?:is|are|was|were) no\b|\bwhere there (?:is|are) no\b")


def pages(root):
    yield from ("README.md", "CONTRIBUTING.md")
    for folder, _, names in sorted(os.walk(os.path.join(root, "docs"))):
        for name in sorted(names):
            if name.endswith(".md"):
                yield os.path.relpath(os.path.join(folder, name), root)


def blank(match):
    """Spaces in a match's place: lines keep their numbers."""
    return re.sub(r"[^\n]", " ", match.group(0))


def sentences(text):
    """(line number, sentence) of the prose of a page."""
    text = re.sub(r"^- <!-- subpage .*$", blank, text, flags=re.M)  # a menu
    text = re.sub(r"```.*?```|<!--.*?-->|\\f\[.*?\\f\]", blank, text, flags=re.S)
    text = re.sub(r"\$`[^`]*`\$|`[^`]*`", lambda match: "code" + "\n" * match.group(0).count("\n"), text)
    text = re.sub(r"<[^>\n]+>", blank, text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", lambda match: match.group(1), text)
    paragraphs, now = [], []

    def end():
        if now:
            paragraphs.append(list(now))
            now.clear()

    for number, line in enumerate(text.split("\n"), 1):
        item = re.match(r"^\s*(?:[-*]|\d+\.)\s+", line)
        if item:
            end()
            now.append((number, line[item.end():]))
        elif not line.strip() or re.match(r"^(?:    |\t|\s*\||#|@|\\)", line):
            end()
        else:
            now.append((number, line.strip()))
    end()
    for paragraph in paragraphs:
        joined, starts = "", []
        for number, line in paragraph:
            starts.append((len(joined), number))
            joined += line + " "
        at = 0
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z*`(])", joined):
            place = joined.index(sentence, at)
            at = place + len(sentence)
            yield [number for start, number in starts if start <= place][-1], sentence.strip()


def words_in(sentence):
    return len(re.findall(r"[A-Za-z0-9'%.-]*[A-Za-z0-9%]+", sentence))


def phrases_in(sentence):
    plain = THERE_IS.sub("there exists", sentence.replace("*", ""))
    for pattern, instead in PHRASES:
        found = re.search(pattern, plain)
        if found:
            yield f"'{found.group(0)}': {instead}"


def examine(name, text):
    """(number of sentences, long ones, messages) of a page."""
    count, long, messages = 0, [], []
    for line, sentence in sentences(text):
        count += 1
        words = words_in(sentence)
        if words > MOST_WORDS:
            long.append(f"{name}:{line}: {words} words, at most {MOST_WORDS}: {sentence[:90]}")
        messages += [f"{name}:{line}: {found}" for found in phrases_in(sentence)]
    return count, long, messages


def check(root):
    count, long, wrong = 0, [], []
    for name in pages(root):
        with open(os.path.join(root, name), encoding="utf-8") as file:
            of_page, long_here, messages = examine(name, file.read())
        count += of_page
        long += long_here
        wrong += messages
        if len(long_here) > max(2, MOST_LONG_OF_A_PAGE * of_page):
            wrong.append(f"{name}: {len(long_here)} of {of_page} sentences are long, more than {MOST_LONG_OF_A_PAGE:.0%}")
    share = len(long) / max(1, count)
    print("\n".join(long + wrong))
    print(f"{len(long)} of {count} sentences have more than {MOST_WORDS} words ({share:.1%}, at most {MOST_LONG:.0%}); {len(wrong)} other faults")
    return 1 if wrong or share > MOST_LONG or count < 500 else 0


def words(root):
    total = 0
    for name in pages(root):
        with open(os.path.join(root, name), encoding="utf-8") as file:
            here = sum(words_in(sentence) for _, sentence in sentences(file.read()))
        total += here
        print(f"{here:6} {name}")
    print(f"{total:6} words of prose")
    return 0


def comments_of(text):
    """(line number, paragraph) of each comment of a header."""
    now, first = [], 0
    for number, line in enumerate(text.split("\n") + [""], 1):
        alone, behind = re.match(r"^\s*///?(?!<)\s?(.*)$", line), re.search(r"///<\s*(.*)$", line)
        said = alone.group(1) if alone else ""
        tag = re.match(r"^\s*(?:@(?:param|tparam)\s+\S+|@returns?|@throws|- )\s*", said)
        is_prose = alone and said.strip() and not re.match(r"^(?:    |\||SPDX|Copyright|@file|@snippet|@ingroup|clang-format)", said)
        if now and (not is_prose or tag):
            yield first, " ".join(now)
            now = []
        if is_prose:
            first = first if now else number
            now.append(said[tag.end():] if tag else said.strip())
        elif behind:
            yield number, behind.group(1)


def comments(root):
    count = long = 0
    for folder, _, names in sorted(os.walk(os.path.join(root, "include"))):
        for name in sorted(names):
            path = os.path.join(folder, name)
            with open(path, encoding="utf-8") as file:
                text = file.read()
            for line, paragraph in comments_of(text):
                plain = re.sub(r"`[^`]*`", "code", paragraph)
                for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z*`(])", plain):
                    count += 1
                    if words_in(sentence) > MOST_WORDS:
                        long += 1
                        print(f"{os.path.relpath(path, root)}:{line}: {words_in(sentence)} words: {sentence[:90]}")
    print(f"{long} of {count} sentences of comments have more than {MOST_WORDS} words ({long / max(1, count):.1%})")
    return 0


BAD = """# A page

What scores best is named. A reading that is off is no gap.

- Nothing acts here but for the drive.

This sentence has a great many words in it, more than anybody who reads in a hurry and in a second language can hold in mind until the full stop comes.
"""
GOOD = """# What a heading says does not matter

The likeliest explanation is named. There is no gap here.

    What stands in code is no prose.

| what stands in a table | is no prose |
"""


def test():
    count, long, messages = examine("bad", BAD)
    assert count == 4, count
    assert [one.split(": ")[0] for one in long] == ["bad:7"], long
    assert [one.split(": ")[0] for one in messages] == ["bad:3", "bad:3", "bad:5"], messages
    count, long, messages = examine("good", GOOD)
    assert (count, long, messages) == (2, [], []), (count, long, messages)
    print("a bad sample is noticed, a good one passes")
    return 0


def main():
    if sys.argv[1:] == ["test"]:
        return test()
    if len(sys.argv) == 3 and sys.argv[1] in ("check", "words", "comments"):
        return {"check": check, "words": words, "comments": comments}[sys.argv[1]](sys.argv[2])
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
