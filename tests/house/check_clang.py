#!/usr/bin/env python3
"""Checks that clang compiles the project's own units without a warning, by their syntax alone.

Usage: check_clang.py [--jobs N] CLANG BUILD [FOLDER...]
BUILD is a build directory with compile_commands.json in which everything was built, since units include generated
headers. FOLDERs limit what is checked. Warnings are those that the build asks for; units that it
compiles without any are generated, and are left out.

Most of the time of a unit goes into what it includes, so units with the same options are read together, as one. Those
that do not go together (two of them name something alike) are set apart and read again, in the end each alone: what is
reported is what clang says of one unit by itself.

Where there is ccache it remembers what clang said, and nothing is read again while it and what it includes are as they
were. All names are handed to it relative to ROOT, so that it knows them in another clone, too.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

# The options of a unit's command line that decide how it is read. -O is not among them: nothing is compiled.
KEPT = ("-I", "-isystem", "-D", "-std", "-W")
TOGETHER = 60  # units in one reading at most
ENOUGH_FAILURES = 10
SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def relative(path, folder):
    """The path as seen from a folder, if both are of this project; else as it is."""
    inside = all(pathlib.Path(p).is_relative_to(ROOT) for p in (path, folder))
    return os.path.relpath(path, folder) if inside else str(path)


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


def sources_of(path):
    """The source, or those that the build compiles as one by a file of its own, which includes them."""
    if pathlib.Path(path).parent.name != "Unity":
        return [path]
    return re.findall(r'^#include "(.*)"$', pathlib.Path(path).read_text(), re.M)


def units_by_options(build, folders):
    """The units to check, each once for each language standard, as lists of paths by their options."""
    seen = set()
    by_options = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        options = options_of(entry["command"])
        standard = next((o for o in options if o.startswith("-std")), "")
        if "-Wall" not in options:
            continue
        for path in sources_of(entry["file"]):
            if (path, standard) in seen:
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
        self.with_ccache = shutil.which("ccache") is not None
        version = subprocess.run([clang, "--version"], capture_output=True, text=True, check=True).stdout
        reader = hashlib.sha256((version + (HERE / "clang_syntax.sh").read_text()).encode()).hexdigest()
        self.environment = {**os.environ, "RABIT_CLANG": clang, "CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1",
                            "CCACHE_DEPEND": "1", "CCACHE_COMPILERTYPE": "clang",
                            "CCACHE_COMPILERCHECK": f"string:{reader}"}

    def says(self, options, path):
        """What clang has against a file, or nothing."""
        options = [*options, "-Werror", "-Wno-unknown-warning-option", "-ferror-limit=0"]
        if not self.with_ccache:
            done = self.run([self.clang, *options, "-fsyntax-only", path])
            return done.stderr or f"{self.clang} failed" if done.returncode != 0 else ""
        left = self.work / hashlib.sha256(str((options, path)).encode()).hexdigest()
        verdict = left.with_suffix(".o")
        done = self.run(["ccache", str(HERE / "clang_syntax.sh"), *options, "-MD", "-MF", f"{left}.d", "-MT", "unit",
                         "-c", path, "-o", str(verdict)])
        if done.returncode != 0:
            return done.stderr or f"{self.clang} failed"
        return verdict.read_text().removeprefix("read\n")

    def run(self, command):
        return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=self.environment)

    def together(self, options, units):
        """The units that clang finds fault with when they are read as one."""
        # Each program's own main().
        text = "".join(f'#undef main\n#define main main_{i}\n#include "{relative(unit, self.work)}"\n'
                       for i, unit in enumerate(units))
        file = self.work / f"together_{hashlib.sha256(text.encode()).hexdigest()}.cpp"
        file.write_text(text)
        joined = relative(file, ROOT)
        said = self.says(options, joined)
        at_fault = {units[(int(number) - 1) // 3]
                    for number in re.findall(rf"^In file included from {re.escape(joined)}:(\d+):", said, re.M)}
        return (at_fault or set(units)) if said else set()

    def check(self, options, units):
        """Adds to the failures what clang says of the units."""
        if not units or len(self.failures) >= ENOUGH_FAILURES:
            return
        if len(units) == 1 or options[0]:
            for unit in units:
                said = self.says(options[1:], relative(unit, ROOT))
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
    work = build / "house_clang"
    work.mkdir(exist_ok=True)
    checker = Checker(clang, work)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done in [pool.submit(checker.check, options, part)
                     for options, units in by_options.items() for part in parts(units)]:
            done.result()
    return sorted(checker.failures), sum(len(units) for units in by_options.values())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("clang")
    parser.add_argument("build", type=lambda folder: pathlib.Path(folder).resolve())
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
