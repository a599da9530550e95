#!/usr/bin/env python3
"""The law by which the gateways' own traffic grows with a fleet, over a wire that counts: what a node writes does not
grow beyond a few nodes, and what arrives at it grows with the number of the others.

Usage: fleet_test.py BENCH_FLEET [SIZE...]"""

import json
import subprocess
import sys

SIZES = [2, 5, 10, 20, 40, 100]
# Two beats a second; announcements are sent once.
MOST_WRITES_PER_S = 2.05
# A beat echoes up to two others; names here have up to six letters.
MOST_BYTES_PER_S = 300


def main():
    program, *sizes = sys.argv[1:]
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
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
