#!/usr/bin/env python3
"""Checks that clang compiles the project's own units without a warning, by their syntax alone.

Usage: check_clang.py [--jobs N] CLANG BUILD [FOLDER...]
BUILD is a build directory with compile_commands.json in which everything was built, since units include generated
headers. FOLDERs limit what is checked. Warnings are those that the build asks for; units that it
compiles without any are generated, and are left out.

Most of the time of a unit goes into what it includes, so units with the same options are read together, as one. Those
that do not go together (two of them name something alike) are set apart and read again, in the end each alone: what is
reported is what clang says of one unit by itself.
"""

import argparse
import concurrent.futures
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

# What of a unit's command line says how it is to be read. -O is not among it: nothing is compiled.
KEPT = ("-I", "-isystem", "-D", "-std", "-W")
TOGETHER = 60  # units in one reading at most
ENOUGH_FAILURES = 10
SKIPPED = 77


def options_of(command):
    """The options of a compile command that clang is to have."""
    words = shlex.split(command)
    kept = []
    for word, following in zip(words, [*words[1:], ""]):
        if word in ("-I", "-isystem", "-D"):
            kept += [word, following]
        elif word.startswith(KEPT):
            kept.append(word)
    return kept


def units_by_options(build, folders):
    """The units to check, each once for each language standard, as lists of paths by their options."""
    seen = set()
    by_options = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = entry["file"]
        options = options_of(entry["command"])
        standard = next((o for o in options if o.startswith("-std")), "")
        if "-Wall" not in options or (path, standard) in seen:
            continue
        if folders and not any(pathlib.Path(path).is_relative_to(folder) for folder in folders):
            continue
        seen.add((path, standard))
        by_options.setdefault((path.endswith(".c"), *options), []).append(path)
    return by_options


class Checker:
    def __init__(self, clang, work):
        self.clang = clang
        self.work = work
        self.failures = []
        self.count = 0

    def says(self, options, path):
        """What clang has against a file, or nothing."""
        done = subprocess.run([self.clang, *options, "-Werror", "-Wno-unknown-warning-option", "-fsyntax-only",
                               "-ferror-limit=0", path], capture_output=True, text=True, check=False)
        return done.stderr if done.returncode != 0 else ""

    def together(self, options, units):
        """The units that clang finds fault with when they are read as one."""
        self.count += 1
        joined = self.work / f"together_{self.count}.cpp"
        # Each program's own main().
        lines = [f'#undef main\n#define main main_{i}\n#include "{unit}"\n' for i, unit in enumerate(units)]
        joined.write_text("".join(lines))
        said = self.says(options, str(joined))
        at_fault = {units[(int(number) - 1) // 3]
                    for number in re.findall(rf"^In file included from {re.escape(str(joined))}:(\d+):", said, re.M)}
        return (at_fault or set(units)) if said else set()

    def check(self, options, units):
        """Adds to the failures what clang says of the units."""
        if not units or len(self.failures) >= ENOUGH_FAILURES:
            return
        if len(units) == 1 or options[0]:
            for unit in units:
                said = self.says(options[1:], unit)
                if said:
                    self.failures.append((unit, said))
            return
        at_fault = self.together(options[1:], units)
        if not at_fault:
            return
        good = [unit for unit in units if unit not in at_fault]
        bad = [unit for unit in units if unit in at_fault]
        if not good:
            good, bad = bad[:len(bad) // 2], bad[len(bad) // 2:]
        self.check(options, good)
        self.check(options, bad)


def parts(units):
    """The units in parts of about the same size, none of them too big for one reading."""
    count = -(-len(units) // TOGETHER)
    return [units[i * len(units) // count:(i + 1) * len(units) // count] for i in range(count)]


def check(clang, build, folders, jobs):
    """What clang says, as (unit, text), and the number of units."""
    by_options = units_by_options(build, folders)
    with tempfile.TemporaryDirectory(prefix="rabit_clang_") as work:
        checker = Checker(clang, pathlib.Path(work))
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            for done in [pool.submit(checker.check, options, part)
                         for options, units in by_options.items() for part in parts(units)]:
                done.result()
    return sorted(checker.failures), sum(len(units) for units in by_options.values())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("clang")
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folders", nargs="*", type=lambda folder: pathlib.Path(folder).resolve())
    arguments = parser.parse_args()
    if not shutil.which(arguments.clang):
        print(f"skipped: no {arguments.clang} here; docker/packages-check.txt lists it")
        return SKIPPED
    failures, units = check(arguments.clang, arguments.build, arguments.folders, arguments.jobs)
    for _, said in failures:
        print(said)
    print(f"{len(failures)} of {units} units failed")
    return 1 if failures or units == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
