#!/usr/bin/env python3
"""Fails if the gateway has got worse, beside DDS by hand, than results/guard.json says.

Usage: pairs_guard.py [--update] [--only TEXT] [--rounds N] PROGRAMS

Raw and Rabit run in turns, and the ratio of each pair of neighbours counts: what disturbs the machine disturbs both.
judged.py decides. The exit code is 1 if a ratio got worse, 77 if none did and one could not be judged, else 0. --update
writes the ratios that were measured closely as the new ones. Nothing is measured while other programs compute
(tests/quiet.py): beside them the ratios are others.

A sleeping processor wakes up late, which hides work. So while this measures, a process of the lowest priority keeps
each processor awake; it takes no time from others."""

import argparse
import contextlib
import json
import os
import pathlib
import subprocess
import sys

import contestants
import judged
import plan
import report
from contestants import NODE, RAW_WORKER, quiet
from run import run_once
from skipped import skip

WRITTEN = pathlib.Path(__file__).resolve().parent.parent / "results" / "guard.json"
# The case, and what of it is guarded. Rates are better if they are higher.
GUARDED = {"latency {} state 100 B": ["p50_us", "cpu_us"],
           "latency {} telemetry 100 B": ["p50_us", "cpu_us"],
           "latency {} queue 100 B": ["p50_us", "cpu_us"],
           "latency {} state 1 MB": ["p50_us"],
           "latency {} queue 1 MB": ["p50_us"],
           "throughput {} queue 100 B": ["per_s"],
           "throughput {} queue 1 MB": ["per_s"]}
RATES = {"per_s"}
# Of the messages of a full run: the medians of many short runs say more than that of one long run.
SCALE = 0.3


@contextlib.contextmanager
def processors_awake():
    """Keeps each processor busy with work that gives way to all other."""
    idle = [subprocess.Popen(["chrt", "--idle", "0", "taskset", "--cpu-list", str(cpu), sys.executable, "-c",
                              "while True: pass"]) for cpu in sorted(os.sched_getaffinity(0))]
    try:
        yield
    finally:
        for process in idle:
            process.kill()
            process.wait()


def ratios(programs, case, names, rounds):
    """{name: how many times the cost of raw ours is, of each round}; of a rate its inverse."""
    found = {name: [] for name in names}
    for index in range(rounds):
        # Each contestant is first in every other round.
        order = [RAW_WORKER, NODE] if index % 2 == 0 else [NODE, RAW_WORKER]
        values = {contestant: run_once(programs, case, contestant, 0) for contestant in order}
        for name in names:
            raw, ours = values[RAW_WORKER][name], values[NODE][name]
            found[name].append(raw / ours if name in RATES else ours / raw)
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--only", default="", help="cases whose name contains this")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("programs", type=pathlib.Path)
    arguments = parser.parse_args()
    contestants.harness.enter_namespace()
    quiet.refuse_noise("a ratio")
    load = quiet.Load()
    programs = contestants.Contestants(arguments.programs, contestants.harness.domain())
    written = json.loads(WRITTEN.read_text()) if WRITTEN.exists() else {"ratios": {}}
    cases = {case.key(): case for case in plan.all_cases(programs.transports, SCALE)}
    verdicts = set()
    print("| what | written | now | verdict |\n|---|---|---|---|")
    with processors_awake():
        for transport in programs.transports:
            for key, names in GUARDED.items():
                key = key.format(transport)
                if arguments.only not in key:
                    continue
                found = ratios(programs, cases[key], names, arguments.rounds)
                was = {name: written["ratios"].get(f"{key}, {name}") for name in names}
                if any(judged.verdict(was[name], found[name]) in (judged.WORSE, judged.UNDECIDED) for name in names):
                    more = ratios(programs, cases[key], names, 2 * arguments.rounds)
                    found = {name: found[name] + more[name] for name in names}
                for name in names:
                    verdict = judged.verdict(was[name], found[name])
                    low, middle, high = judged.median_within(found[name])
                    verdicts.add(verdict)
                    print(f"| {key}, {name} | {was[name] or '-'} | {middle:.2f} ({low:.2f} to {high:.2f}) | {verdict} |",
                          flush=True)
                    if arguments.update and judged.is_close(found[name]):
                        written["ratios"][f"{key}, {name}"] = round(middle, 2)
    print(f"\nWritten at {written.get('machine')}")
    if arguments.update:
        written["machine"] = report.machine(load)
        WRITTEN.write_text(json.dumps(written, indent=1) + "\n")
        return 0
    if judged.WORSE in verdicts:
        return 1
    return 0 if verdicts - {judged.UNKNOWN} == {judged.GOOD} else skip("no ratio is known, or none could be judged")


if __name__ == "__main__":
    sys.exit(main())
