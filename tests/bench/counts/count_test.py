#!/usr/bin/env python3
"""Instructions and allocations of the core and of the gateway for one message, held against limits.json. They do not
depend on how busy the machine is.

Usage: count_test.py DIRECTORY_OF_PROGRAMS [--allocations] [--update]
--allocations holds only these against the limits, since instructions depend on the compiler.
--update writes new limits: what is measured, and 5 % for another processor's memcpy and another build of a library."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

LIMITS = pathlib.Path(__file__).resolve().parent / "limits.json"
MESSAGES = 3000
PROGRAMS = {"bench_core_counts": ["post", "post-fetch", "queue-add"],
            "bench_counts": ["codec", "state", "telemetry", "queue", "packed-queue"],
            "bench_seal_counts": ["seal-pairwise", "seal-open-pairwise", "open-replay"]}
INSTRUCTIONS_MARGIN = 1.05
# Some work comes once a second and may or may not fall into the measured time.
ALLOCATIONS_MARGIN = 0.05


def allocations(program, scenario):
    return json.loads(subprocess.run([program, scenario, str(MESSAGES)], check=True, text=True,
                                     capture_output=True).stdout)["allocations"]


def instructions(program, scenario):
    """The least of a few, between which the stack is moved: how memory happens to lie decides about half a percent, by
    what is copied in one piece, and that depends on how long paths and the environment are."""
    return min(instructions_once(program, scenario, shift) for shift in range(0, 64, 16))


def instructions_once(program, scenario, shift):
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["valgrind", "--tool=callgrind", "--collect-atstart=no", "--toggle-collect=Measured",
                              f"--callgrind-out-file={folder}/out", program, scenario, str(MESSAGES)],
                             check=True, text=True, capture_output=True,
                             env={**os.environ, "RABIT_STACK_SHIFT": "x" * shift})
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1)) / MESSAGES


def main():
    directory = pathlib.Path(sys.argv[1])
    limits = json.loads(LIMITS.read_text()) if LIMITS.exists() else {}
    good = True
    print("| a message | instructions | at most | allocations | at most |\n|---|---|---|---|---|")
    for program, scenario in [(directory / program, name) for program, names in PROGRAMS.items() for name in names]:
        measured = {"instructions": instructions(program, scenario), "allocations": allocations(program, scenario)}
        if "--update" in sys.argv:
            limits[scenario] = {"instructions": round(measured["instructions"] * INSTRUCTIONS_MARGIN),
                                "allocations": round(measured["allocations"] + ALLOCATIONS_MARGIN, 2)}
        limit = limits[scenario]
        good = good and all(measured[name] <= limit[name] for name in measured
                            if name == "allocations" or "--allocations" not in sys.argv)
        print(f"| {scenario} | {measured['instructions']:.0f} | {limit['instructions']} | "
              f"{measured['allocations']:.2f} | {limit['allocations']} |", flush=True)
    if "--update" in sys.argv:
        LIMITS.write_text(json.dumps(limits, indent=1) + "\n")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
