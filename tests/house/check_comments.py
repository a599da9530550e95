#!/usr/bin/env python3
"""No comment of several lines was cut: none ends or begins in the middle of a sentence, and none has a hole.

Usage: check_comments.py ROOT"""

import pathlib
import re
import sys

ROOMS = ("base", "core", "docker", "docs", "examples", "gateway", "idl", "tests", "transport")
COMMENT = re.compile(r"\s*//+( *)(.*\S)\s*$")
STOP = re.compile(r"""[.:;!?)\]}>`"]$""")
# A list, a table or a line of code has its own form.
LAYOUT = re.compile(r"- |\S.*?\s{3}")
# A last line that is this long was wrapped, so a word may have followed. Columns.
LONG = 70
# No sentence ends with these, and no comment begins with them.
JOINS = r"(?:a|an|and|as|at|but|by|for|from|if|in|into|is|nor|of|on|or|so|than|that|the|to|was|which|with)"
ENDS_OPEN = re.compile(rf"\b{JOINS}$")
BEGINS_OPEN = re.compile(rf"{JOINS} [a-z]+\b")
# Sentences begin with these words, and no name does.
BEGINS = re.compile(r"(?:An|As|Does|Each|If|In|It|Its|Never|Not|On|Otherwise|Returns|Since|So|Takes|The|Then|These|They|This|"
                    r"Those|Throws|When|While|With|Without|Writes) [a-z]")


def blocks(lines):
    """Yields runs of comment lines: the number of the first one, and (indentation, text) of each."""
    first, block = 0, []
    for number, line in enumerate([*lines, ""], 1):
        match = COMMENT.match(line)
        if match:
            first = first if block else number
            block.append((len(match[1]), match[2]))
        elif block:
            yield first, block, len(lines[number - 2].rstrip())
            block = []


def faults(lines):
    for first, block, width in blocks(lines):
        if len(block) < 2:
            continue
        if BEGINS_OPEN.match(block[0][1]):
            yield first, f"begins in the middle of a sentence: {block[0][1]}"
        indentation, last = block[-1]
        if indentation < 2 and not STOP.search(last) and not LAYOUT.match(last) and (width >= LONG or ENDS_OPEN.search(last)):
            yield first + len(block) - 1, f"ends in the middle of a sentence: {last}"
        for number, (before, after) in enumerate(zip(block, block[1:]), first):
            if before[0] == after[0] and not STOP.search(before[1]) and not LAYOUT.match(before[1]) and BEGINS.match(after[1]):
                yield number, f"lacks words between \"{before[1]}\" and \"{after[1]}\""


def violations(root):
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in {".h", ".hpp", ".cpp", ".c", ".idl"} and "node_modules" not in path.parts:
                for number, fault in faults(path.read_text(encoding="utf-8").splitlines()):
                    yield f"{path.relative_to(root).as_posix()}:{number}: this comment {fault}"


def main():
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
