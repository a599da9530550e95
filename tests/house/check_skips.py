#!/usr/bin/env python3
"""Each test that can be skipped says why in one form: only skip() of tests/skipped.py and of tests/skip.sh end a test with 77.

Usage: check_skips.py ROOT"""

import pathlib
import re
import sys

# The exit code, written where a program ends or where it is given a name.
ENDS = re.compile(r"\b(?:exit\(?|return|SKIPPED =) ?77\b|\"skipped: ")
# The mechanism itself, and the tests that read what it says.
ALLOWED = {"tests/skip.sh", "tests/skipped.py", "tests/night/run.py", "tests/house/check_skips.py", "tests/night/night_test.py",
           "tests/integration/without_namespaces_test.py"}


def violations(root):
    for path in sorted((root / "tests").rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix in {".py", ".sh", ".c", ".cpp", ".mjs"} and name not in ALLOWED and "node_modules" not in name:
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                if ENDS.search(line):
                    yield f"{name}:{number}: skips by itself: {line.strip()}"


def main():
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
