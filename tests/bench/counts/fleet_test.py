#!/usr/bin/env python3
"""The law by which the gateways' own traffic and work grow with a fleet, over a wire that counts: what a node writes does
not grow beyond a few nodes, what arrives at it grows with the number of the others, and so does its work in flight.

Usage: fleet_test.py BENCH_FLEET [--instructions] [SIZE...]"""

import json
import re
import subprocess
import sys
import tempfile

SIZES = [2, 5, 10, 20, 40, 100]
# Two beats a second; announcements are sent once.
MOST_WRITES_PER_S = 2.05
# A beat echoes up to two others; names here have up to six letters.
MOST_BYTES_PER_S = 300
# Of a flying fleet: by size, at most how many instructions a second a node takes for each other node; 5 % above what was
# measured. A term in the square of the fleet shows at the larger size.
FLYING = {20: 38100, 60: 27700}
FLYING_S = 2


def instructions_for_each_other(program, size):
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder}/out",
                              program, str(size), "flying"], check=True, text=True, capture_output=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1)) / size / FLYING_S / (size - 1)


def work_grows_with_others(program):
    good = True
    print("\n| nodes in flight | instructions a second for each other node | at most |\n|---|---|---|")
    for size, most in FLYING.items():
        cost = instructions_for_each_other(program, size)
        print(f"| {size} | {cost:.0f} | {most} |", flush=True)
        good = good and cost <= most
    return good


def main():
    program, *sizes = [argument for argument in sys.argv[1:] if argument != "--instructions"]
    good = True
    print("| nodes | samples a node writes a second | bytes | samples that arrive at it a second | bytes |")
    print("|---|---|---|---|---|")
    for size in map(int, sizes or SIZES):
        run = subprocess.run([program, str(size)], check=True, text=True, capture_output=True)
        row = json.loads(run.stdout)
        print(f"| {size} | {row['writes_per_s']:.1f} | {row['written_bytes_per_s']:.0f} | "
              f"{row['arrivals_per_s']:.0f} | {row['arrived_bytes_per_s']:.0f} |", flush=True)
        good = (good and row["writes_per_s"] <= MOST_WRITES_PER_S and row["written_bytes_per_s"] <= MOST_BYTES_PER_S
                and row["arrivals_per_s"] <= MOST_WRITES_PER_S * (size - 1)
                and row["arrived_bytes_per_s"] <= MOST_BYTES_PER_S * (size - 1))
    # Instructions are those of optimized code.
    if "--instructions" in sys.argv:
        good = work_grows_with_others(program) and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
