#!/usr/bin/env python3
"""Breaks rules of classes that the simulations do not reach, one after the other, and shows that their tests notice.

    mutations.py --source REPOSITORY --build DIRECTORY --work DIRECTORY [--jobs 2] [--only TEXT]

For each mutation of the lists beside this file: the changed source is compiled and linked as the project's build does it
(BUILD, a ninja build in which the test programs are up to date; nothing in there is changed), into a program of its own,
and the tests named must fail. Exit status 1 if a mutation is not noticed, or does not fit the sources any more.

To add a class: entries in a list, with the path of the file and the program and filter of the tests that must notice. A
source in a library is linked before it; a header reaches the test program's own sources and those beside it.
"""

import argparse
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutants import Mutants  # first, as it finds the module that the lists import
from air_list import MUTATIONS as AIR
from common_list import MUTATIONS as COMMON
from mirrors_list import MUTATIONS as MIRRORS
from seal_list import MUTATIONS as SEAL
from transport_list import MUTATIONS as TRANSPORT

MUTATIONS = [*AIR, *MIRRORS, *TRANSPORT, *SEAL, *COMMON]
# Only keeps a hanging mutant from hanging the run. A mutant that hangs counts as noticed.
LIMIT_S = 120


class Run(Mutants):
    def judge(self, number, change):
        """What noticed, or why nothing did; and whether that is well."""
        program, _, tests = change.noticed_by.partition(":")
        try:
            path = self.mutant(change, number, program)
            run = subprocess.run([str(path), f"--gtest_filter={tests or '*'}", "--gtest_brief=1", "--gtest_fail_fast"],
                                 capture_output=True, text=True, timeout=LIMIT_S, cwd=self.build, check=False)
        except subprocess.TimeoutExpired:
            return True, "the tests do not end"
        except RuntimeError as error:
            return False, str(error)
        finally:
            shutil.rmtree(self.work / f"mutant_{number}", ignore_errors=True)
        if run.returncode == 0:
            return False, "NOT NOTICED"
        failed = re.search(r"\[  FAILED  \] (\S+)", run.stdout)
        return True, failed.group(1) if failed else f"ended with status {run.returncode}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    run = Run(arguments.source.resolve(), arguments.build.resolve(), arguments.work.resolve())
    chosen = [change for change in MUTATIONS if arguments.only in f"{change.file} {change.name}"]
    missed = 0
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for change, (well, what) in zip(chosen, pool.map(run.judge, range(len(chosen)), chosen)):
            print(f"{'ok  ' if well else 'FAIL'} {Path(change.file).name}: {change.name}: {what}", flush=True)
            missed += not well
    print(f"{len(chosen) - missed} of {len(chosen)} noticed")
    sys.exit(1 if missed or not chosen else 0)


if __name__ == "__main__":
    main()
