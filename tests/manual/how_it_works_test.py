#!/usr/bin/env python3
"""The page docs/how_it_works.md names classes, functions and files. Each of them exists in the sources.

Usage: how_it_works_test.py REPOSITORY"""

import pathlib
import re
import sys

ROOMS = ("core", "idl", "transport", "gateway")
NAME = re.compile(r"`([A-Z]\w+)(?:::(\w+))?`")
PATH = re.compile(r"`((?:core|idl|transport|gateway)/[\w/.]+)`")


def main():
    root = pathlib.Path(sys.argv[1])
    page = (root / "docs/how_it_works.md").read_text(encoding="utf-8")
    files = [path for room in ROOMS for path in (root / room).rglob("*") if path.suffix in {".h", ".cpp", ".c"}]
    words = set()
    for path in files:
        words.update(re.findall(r"\w+", path.read_text(encoding="utf-8")), [path.stem])
    names = {word for match in NAME.findall(page) for word in match if word}
    paths = set(PATH.findall(page))
    wrong = [f"`{name}` is in no source" for name in sorted(names - words)]
    wrong += [f"`{path}` is no file or folder" for path in sorted(paths) if not (root / path).exists()]
    print("\n".join(wrong) if wrong else f"{len(names)} names and {len(paths)} paths exist")
    return 1 if wrong or not names or not paths else 0


if __name__ == "__main__":
    sys.exit(main())
