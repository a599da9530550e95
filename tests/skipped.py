#!/usr/bin/env python3
"""Ends a test as skipped, and reads why tests were skipped.

  skipped.py JUNIT...   prints one line for each skipped test; the files are those that `ctest --output-junit` wrote"""

import re
import sys
import xml.etree.ElementTree as xml


SKIPPED = 77  # the exit code of a test that this machine does not allow


def skip(reason, package=""):
    """Ends this test as skipped. Its last line says why, and names the Debian package that would help."""
    print(f"skipped: {reason}{'; install ' + package if package else ''}", flush=True)
    sys.exit(SKIPPED)


def reason_of(case):
    """The reason of a skipped test in ctest's junit format: its last line "skipped: REASON", or what GTEST_SKIP was told."""
    output = case.findtext("system-out") or ""
    said = re.findall(r"skipped: (.*)$|: Skipped\n(.+)$", output, re.MULTILINE)
    return next((word.strip() for pair in said[-1:] for word in pair if word.strip()), "")


def is_skipped(case):
    """True if a test in ctest's junit format was skipped by itself, or is disabled. ctest calls "skipped", too, what it could
    not start: that has failed."""
    mark = case.find("skipped")
    return case.get("status") == "disabled" or (mark is not None and mark.get("message", "").startswith("SKIP_"))


def skipped(junit):
    """(name, reason) of each skipped test."""
    return [(case.get("name"), reason_of(case)) for case in xml.parse(junit).getroot().iter("testcase") if is_skipped(case)]


def main(files):
    for file in files:
        for name, reason in skipped(file):
            print(f"skipped: {name}: {reason or 'it does not say why'}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
