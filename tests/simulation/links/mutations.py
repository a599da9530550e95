#!/usr/bin/env python3
"""Breaks each rule of the queue links in turn and shows that the simulation, or a direct test, notices.

    mutations.py --source REPOSITORY --work DIRECTORY [--seeds 20000] [--jobs 2] [--only TEXT]

Compiles the sources of gateway/links in the work directory (not the project's build), then for each mutation of
mutation_list.py one changed source file, and runs the simulation and, if that does not notice, the direct tests.
Exit status 1 if a mutation is not noticed by whom it should be, or does not fit the sources any more.
"""

import argparse
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "common"))
import mutation  # noqa: E402
from mutation_list import MUTATIONS  # noqa: E402

FLAGS = ["-std=c++20", "-O2", "-pthread"]


class Build:
    def __init__(self, source, work, jobs):
        self.work = work
        self.links = source / "gateway/links/src"
        tests = source / "tests/gateway/links"
        simulation = source / "tests/simulation/links"
        common = source / "tests/simulation/common"
        self.includes = [f"-I{path}" for path in (source / "gateway/links/include", self.links, tests, common)]
        self.compiler = os.environ.get("CXX", "c++")
        sources = {
            "links": sorted(self.links.glob("*.cpp")),
            "simulation": sorted([*simulation.glob("*.cpp"), *common.glob("*.cpp")]),
            "direct": [*sorted(tests.glob("Link*Test.cpp")), tests.parent / "AllocationCount.cpp"],
        }
        work.mkdir(parents=True, exist_ok=True)
        # Stands in for the file that rabit_tell_paths of tests/CMakeLists.txt makes.
        paths = work / "paths.cpp"
        paths.write_text("namespace Paths\n{\nextern const char *const SourceFolder;\n"
                         f'const char *const SourceFolder = "{source}";\n}}\n')
        sources["simulation"].append(paths)
        self.objects = {}
        with ThreadPoolExecutor(jobs) as pool:
            for group, files in sources.items():
                files = [file for file in files if group != "simulation" or not file.name.endswith("Test.cpp")]
                names = [work / f"{group}_{file.stem}.o" for file in files]
                list(pool.map(self.compile, files, names))
                self.objects[group] = names

    def compile(self, source, target):
        run = subprocess.run([self.compiler, *FLAGS, *self.includes, "-c", str(source), "-o",
                              str(target)], capture_output=True, text=True)
        if run.returncode != 0:
            raise RuntimeError(f"{source} does not compile:\n{run.stderr}")

    def link(self, group, links, target, libraries=()):
        subprocess.run([self.compiler, *FLAGS, *map(str, self.objects[group]), *map(str, links), *libraries, "-o",
                        str(target)], check=True)

    def mutate(self, change, target):
        """Compiles the changed file and returns the objects of the broken links."""
        changed = self.work / f"mutant_{change.file}"
        changed.write_text(mutation.apply((self.links / change.file).read_text(), change))
        self.compile(changed, target)
        original = self.work / f"links_{Path(change.file).stem}.o"
        return [target if name == original else name for name in self.objects["links"]]


def simulate(build, links, seeds, jobs):
    """Returns the violated invariant, or None."""
    program = build.work / "mutant_simulation"
    build.link("simulation", links, program)
    return mutation.simulate(program, seeds, jobs)


def test(build, links):
    """Returns the first direct test that fails, or None."""
    program = build.work / "mutant_direct"
    build.link("direct", links, program, ["-lgmock_main", "-lgmock", "-lgtest"])
    try:
        run = subprocess.run([str(program)], capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "the tests do not end"
    if run.returncode == 0:
        return None
    failed = re.findall(r"^\[  FAILED  \] (\S+) \(", run.stdout, re.M)
    return failed[0] if failed else f"ended with status {run.returncode}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=20000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()

    start = time.monotonic()
    build = Build(arguments.source.resolve(), arguments.work.resolve(), arguments.jobs)
    problems = 0
    counts = {"simulation": 0, "direct": 0}
    untouched = build.objects["links"]
    for notice in (simulate(build, untouched, 200, arguments.jobs), test(build, untouched)):
        if notice:
            print(f"FAILED the sources as they are: {notice}")
            return 1
    for change in MUTATIONS:
        if arguments.only and arguments.only not in change.name:
            continue
        try:
            links = build.mutate(change, build.work / "mutant.o")
            seeds = arguments.seeds if change.noticed_by == "simulation" else arguments.seeds // 20
            notice = simulate(build, links, seeds, arguments.jobs)
            by = "simulation"
            if notice is None:
                notice, by = test(build, links), "direct"
        except RuntimeError as error:
            notice, by = None, "nobody"
            print(f"FAILED {change.name}: {error}")
            problems += 1
            continue
        if notice is None:
            print(f"FAILED {change.name}: not noticed")
            problems += 1
        elif by == "direct" and change.noticed_by == "simulation":
            print(f"FAILED {change.name}: the simulation does not notice, only {notice}")
            problems += 1
        else:
            counts[by] += 1
            print(f"noticed {change.name}: {notice}", flush=True)
    print(f"{sum(counts.values())} noticed ({counts['simulation']} by the simulation, {counts['direct']} by a direct "
          f"test alone), {problems} problems, {time.monotonic() - start:.0f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
