#!/usr/bin/env python3
"""Measures what the gateway costs beside DDS called by hand, in one session.

Usage: run.py [--quick] [--part PART] [--only TEXT] [--repeat N] [--output FOLDER] PROGRAMS
PROGRAMS is the folder of the programs (build/release/bin). The parts are: pairs (latency, throughput, start, idle),
fleet and instructions. Each is written when it is complete: results/PART.json, results/PART.md and its table in
README.md of FOLDER; without that, or with --only, the tables are printed. Nothing is measured while other programs use 15 %
of a processor or more. --quick: a short version that shows that everything works, whose figures mean little."""

import argparse
import collections
import pathlib
import sys

import contestants
import fleet
import instructions
import plan
import report
from contestants import LOCAL, quiet

# How long idle programs are watched, and how often each measure is repeated; measures not listed: as often as the run
# says.
WATCHED_S = 10
QUICK_WATCHED_S = 2
REPETITIONS = {"idle alone": 1, "idle pair": 1, "fleet": 1, "instructions": 3}


def run_once(programs, case, contestant, watched_s):
    """One repetition: names and values."""
    if case.measure == "fleet":
        return fleet.run(programs, contestant, case.transport, case.options, watched_s)
    if case.measure == "instructions":
        try:
            return instructions.of_a_message(programs, contestant, case.transport, case.options)
        except AssertionError as error:  # callgrind is fifty times as slow: too slow on a full machine
            print(f"not counted: {error}", flush=True)
            return {}
    if case.measure == "start-up":
        return {"first_message_s": programs.start_up(contestant, case.transport)}
    if case.measure.startswith("idle"):
        return programs.idle(contestant, case.transport, 1 if case.measure == "idle alone" else 2, watched_s)
    roles = ("ping", "pong") if case.measure == "latency" else ("source", "sink")
    if contestant == LOCAL:
        roles = ("local-" + roles[0], None)
    pair = programs.pair(contestant, case.transport if contestant != LOCAL else None, roles, case.options)
    client, server = pair["client"], pair["server"]
    # A round trip is two messages.
    messages = 2 if case.measure == "latency" else 1
    values = {"allocations": (client["allocations"] + server["allocations"]) / messages,
              "cpu_us": (client["cpu_ns"] + server["cpu_ns"]) / messages / 1000,
              "sleeps": (client["sleeps"] + server["sleeps"]) / messages}
    if contestant == LOCAL:  # the one process was counted twice
        values = {name: value / 2 for name, value in values.items()}
    if case.measure == "latency":
        for name in ("p50", "p99", "p999"):
            values[name + "_us"] = client[name + "_ns"] / 1000
        values["lost"] = client["lost"]
    else:
        values["per_s"] = case.options["count"] / server["seconds"]
        values["MB_per_s"] = values["per_s"] * case.options["payload"] / 1e6
        values["lost"] = server["missed"]
    return values


def measure(programs, cases, repetitions, watched_s):
    """{case: {contestant: {name: [value of each repetition]}}}"""
    results = {}
    for case in cases:
        rows = {contestant: collections.defaultdict(list) for contestant in case.contestants}
        times = min(repetitions, REPETITIONS.get(case.measure, repetitions))
        for _ in range(times):
            for contestant in case.contestants:
                for name, value in run_once(programs, case, contestant, watched_s).items():
                    rows[contestant][name].append(value)
        results[case.key()] = rows
        print(case.key(), {contestant: {name: round(report.median(values), 3) for name, values in row.items()}
                           for contestant, row in rows.items()}, flush=True)
    return results


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--part", choices=plan.PARTS, help="this part alone")
    parser.add_argument("--only", action="append", default=[], help="cases whose name contains this; may be repeated")
    parser.add_argument("--repeat", type=int)
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("programs", type=pathlib.Path)
    arguments = parser.parse_args()
    contestants.harness.enter_namespace()
    if not arguments.quick:
        quiet.refuse_noise("a table")
    programs = contestants.Contestants(arguments.programs, contestants.harness.domain())
    if not instructions.available():
        print("no valgrind: no instructions are counted", flush=True)
    cases = [case for case in plan.all_cases(programs.transports, 0.02 if arguments.quick else 1)
             if any(text in case.key() for text in arguments.only or [""]) and (case.measure != "instructions" or instructions.available())]
    if arguments.quick:
        cases = plan.a_few(cases)
    repetitions = arguments.repeat or (1 if arguments.quick else 5)
    for part in plan.PARTS:
        of_part = [case for case in cases if case.part() == part and arguments.part in (None, part)]
        if not of_part:
            continue
        load = quiet.Load()
        results = measure(programs, of_part, repetitions, QUICK_WATCHED_S if arguments.quick else WATCHED_S)
        made = report.Report(part, results, programs.transports, load)
        if arguments.output is None or arguments.only:
            print(made.markdown())
        else:
            made.write(arguments.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
