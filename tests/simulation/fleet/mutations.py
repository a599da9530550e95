#!/usr/bin/env python3
"""Breaks what a whole node does in turn and shows that the simulation of the fleet, or a direct test, notices.

    mutations.py --source REPOSITORY --build DIRECTORY --work DIRECTORY [--seeds 500] [--jobs 2] [--only TEXT]

Needs a finished build with ninja. For each mutation of mutation_list.py one changed source file of a room of the gateway
is compiled and linked in the place of its original. Exit status 1 if a mutation is not noticed, or does not fit the
sources any more.
"""

import argparse
import re
import subprocess
import sys
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "mutation"), str(TESTS / "simulation/common")]
import mutation  # noqa: E402
from mutants import Mutants  # noqa: E402
from mutation_list import FLEET, MUTATIONS, THIN  # noqa: E402

FIRST_THIN_SEED = 1000000  # as FleetPlan has it


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
    source = arguments.source.resolve()
    files = {file.name: str(file.relative_to(source)) for file in source.glob("gateway/*/*.cpp")}
    mutants = Mutants(source, arguments.build.resolve(), arguments.work.resolve())
    notice = mutation.simulate(arguments.build.resolve() / "bin/fleet_simulation", 50, arguments.jobs)
    if notice:
        print(f"FAILED the sources as they are: {notice}")
        return 1
    problems = 0
    for change in MUTATIONS:
        if arguments.only and arguments.only not in change.name:
            continue
        try:
            program = mutants.mutant(change._replace(file=files[change.file]), 0, change.noticed_by.split()[0])
            notice = notice_of(program, change, arguments)
            problem = None if notice else "not noticed"
        except (RuntimeError, KeyError) as error:
            problem = str(error)
        print(f"FAILED {change.name}: {problem}" if problem else f"noticed {change.name}: {notice}", flush=True)
        problems += 1 if problem else 0
    print(f"{len(MUTATIONS)} mutations, {problems} problems, {time.monotonic() - start:.0f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
