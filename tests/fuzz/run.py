#!/usr/bin/env python3
"""Runs a target of libFuzzer on its seeds (seeds.py), and prints how much of the parser it reached.

Usage: run.py PROGRAM [--runs N] [--seconds N] [--seed N] [--keep FOLDER]
--runs: so many inputs, always the same ones (default); --seconds: for so long. --keep: the folder of the inputs found, which
the next run begins with. An input that ends the program is written into the working directory."""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

import seeds

LARGEST = 32768
SLOWEST_S = 10
MEMORY_MB = 2048


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=1000)
    parser.add_argument("--seconds", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    target = options.program.name.removeprefix("fuzz_")
    limit = f"-max_total_time={options.seconds}" if options.seconds else f"-runs={options.runs}"
    with tempfile.TemporaryDirectory() as folder:
        first = pathlib.Path(folder) / "seeds"
        first.mkdir()
        seeds.write(target, first)
        found = options.keep or pathlib.Path(folder) / "found"
        found.mkdir(parents=True, exist_ok=True)
        # Each line of a run names the reached edges (cov) and edges with counts (ft).
        done = subprocess.run([options.program, limit, f"-seed={options.seed}", f"-max_len={LARGEST}", f"-timeout={SLOWEST_S}",
                               f"-rss_limit_mb={MEMORY_MB}", "-print_final_stats=1", found, first],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                              env={**os.environ, "ASAN_OPTIONS": "detect_leaks=1:allocator_may_return_null=0"})
    lines = done.stdout.decode(errors="replace").splitlines()
    if done.returncode == 0:
        covered = [line for line in lines if " cov: " in line][-1:]
        lines = [line for line in lines if line.startswith(("Done", "stat::"))] + covered
    print("\n".join(lines))
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
