#!/usr/bin/env python3
"""Measures the processor time of the compiler, without a cache: of the demo's programs, of the rest of the gate's tests, and
of a change to a header that most sources include. Fails if one is more than a tenth above its budget in compile.json.

Usage: compile_test.py [--write]
--write puts the figures into compile.json."""

import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
import skipped  # noqa: E402

BUDGET = ROOT / "tests/night/compile.json"
HEADER = "transport/include/rabit/transport/Transport.h"
WITHOUT_CACHE = ["-DCMAKE_C_COMPILER_LAUNCHER=", "-DCMAKE_CXX_COMPILER_LAUNCHER="]


def seconds(*command):
    """Processor seconds of a command and its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def measure(folder):
    source, build = folder / "source", folder / "build"
    subprocess.run(["git", "clone", "--quiet", ROOT, source], check=True)
    os.chdir(source)
    subprocess.run(["cmake", "--preset", "release", "-B", build, *WITHOUT_CACHE], check=True, stdout=subprocess.DEVNULL)
    targets = ("cmake", "--build", build, "--target")
    figures = {"demo": seconds(*targets, "uav", "vision", "ground"), "gate": seconds(*targets, "gate_tests")}
    text = (source / HEADER).read_text()
    (source / HEADER).write_text(text + "// changed\n")
    figures["header"] = seconds(*targets, "gate_tests")
    figures["gate"] += figures["demo"]
    return figures


def main():
    if not BUDGET.exists() and "--write" not in sys.argv[1:]:
        skipped.skip("there is no budget yet: compile_test.py --write makes it")
    with tempfile.TemporaryDirectory() as folder:
        figures = measure(pathlib.Path(folder))
    if "--write" in sys.argv[1:]:
        BUDGET.write_text(json.dumps(figures, indent=2) + "\n")
    budget = json.loads(BUDGET.read_text())
    above = 0
    for name, figure in figures.items():
        above += figure > 1.1 * budget[name]
        print(f"{name}: {figure} s of the processor, budget {budget[name]} s{' ABOVE' if figure > 1.1 * budget[name] else ''}")
    return 1 if above else 0


if __name__ == "__main__":
    sys.exit(main())
