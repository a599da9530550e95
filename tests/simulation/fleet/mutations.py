#!/usr/bin/env python3
"""Breaks what a whole node does in turn and shows that the simulation of the fleet, or a direct test, notices.

    mutations.py --source REPOSITORY --build DIRECTORY --work DIRECTORY [--seeds 500] [--jobs 2] [--only TEXT]

Needs a finished build with ninja. For each mutation of mutation_list.py one changed source file of a room of the gateway
is compiled and linked in the place of its original. Exit status 1 if a mutation is not noticed, or does not fit the
sources any more.
"""

import argparse
import json
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "common"))
import mutation  # noqa: E402
from mutation_list import FLEET, MUTATIONS, THIN  # noqa: E402

FIRST_THIN_SEED = 1000000  # as FleetPlan has it


class Build:
    """The commands of a build directory, turned to mutants."""

    def __init__(self, source, build, work):
        self.gateway = source / "gateway"
        self.build = build
        self.work = work
        work.mkdir(parents=True, exist_ok=True)
        entries = json.loads(self.ninja("compdb"))
        self.compilers = {}
        for entry in entries:
            file = (build / entry["file"]).resolve()
            if file.parent.parent == self.gateway and "rabit_gateway.dir" in entry["output"]:
                self.compilers[file.name] = (shlex.split(entry["command"]), file, entry["file"], entry["output"])

    def ninja(self, tool, *arguments):
        return subprocess.run(["ninja", "-C", str(self.build), "-t", tool, *arguments], check=True, capture_output=True,
                              text=True).stdout.replace("ninja: Entering directory", "")

    def run(self, command):
        run = subprocess.run(command, cwd=self.build, capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{' '.join(command[-2:])} fails:\n{run.stderr[:2000]}")

    def mutate(self, change):
        """Returns the program that must notice, with the changed file in it."""
        changed = self.work / f"mutant_{change.file}"
        command, original, file, output = self.compilers[change.file]
        changed.write_text(mutation.apply(original.read_text(), change))
        mutant = self.work / "mutant.o"
        # Unused parameters and the like are what mutations leave behind.
        words = [str(changed) if word == file else str(mutant) if word == output else word for word in command
                 if word != "-Werror"]
        self.run(words)
        # Before the library, of which the original is not taken then.
        name = change.noticed_by.split()[0]
        program = self.work / f"mutant_{name}"
        link = self.ninja("commands", name).splitlines()[-1]
        words = shlex.split(link.split("&&")[1])  # around it: `:`, and what looks for the tests in the program
        at = words.index("-o")
        self.run([*words[:at], str(mutant), "-o", str(program), *words[at + 2:]])
        return program


def test(program):
    """Runs a test program. Returns the first test that fails, or None."""
    run = subprocess.run([str(program)], capture_output=True, text=True, timeout=300)
    failed = re.findall(r"^\[  FAILED  \] (\S+) \(", run.stdout, re.M)
    return failed[0] if failed else None


def notice_of(program, change, arguments):
    if change.noticed_by == FLEET:
        return mutation.simulate(program, arguments.seeds, arguments.jobs)
    if change.noticed_by == THIN:
        return mutation.simulate(program, arguments.seeds, arguments.jobs, FIRST_THIN_SEED)
    return test(program)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=500)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()

    start = time.monotonic()
    build = Build(arguments.source.resolve(), arguments.build.resolve(), arguments.work.resolve())
    notice = mutation.simulate(arguments.build.resolve() / "bin/fleet_simulation", 50, arguments.jobs)
    if notice:
        print(f"FAILED the sources as they are: {notice}")
        return 1
    problems = 0
    for change in MUTATIONS:
        if arguments.only and arguments.only not in change.name:
            continue
        try:
            notice = notice_of(build.mutate(change), change, arguments)
            problem = None if notice else "not noticed"
        except (RuntimeError, KeyError) as error:
            problem = str(error)
        print(f"FAILED {change.name}: {problem}" if problem else f"noticed {change.name}: {notice}", flush=True)
        problems += 1 if problem else 0
    print(f"{len(MUTATIONS)} mutations, {problems} problems, {time.monotonic() - start:.0f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
