#!/usr/bin/env python3
"""Measures fleets on thin radios, and prints a table: nodes with gateways, and plain DDS programs where they can do the
work. rows.py has the rows and their limits, measures.py and meeting.py what the figures are.

Usage: radio_table.py [--only TEXT]... [--long | --cut SECONDS] [--transports NAME,...] [--keys] [--budget B/s] [--output FILE]
                      [--judge] PROGRAMS
A transport is a backend, or mixed: the nodes have the two in turns. PROGRAMS is the folder of the programs (build/release/bin). --only: rows whose name has that text. --long: also rows that
take minutes; --cut: those too, but none is watched for longer than that. --keys: all nodes have keys; plain programs are left out. --budget: of each node of the examples, or `auto`. --output writes FILE.json and FILE.md. --judge: exit code 1 if a limit is missed. Exit code 77: this
machine does not allow it."""

import argparse
import datetime
import json
import operator
import os
import pathlib
import subprocess
import sys

import measures
import meeting
import rows
from rows import MIXED, PLAIN, RABIT

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402
import radio_field  # noqa: E402

NAMES = {"fastdds": "Fast DDS", "cyclonedds": "Cyclone DDS", MIXED: "both backends"}
COMPARE = {"<=": operator.le, ">=": operator.ge}


def missed(row, figures):
    """The limits that are not met, in words."""
    return [f"{name} {text(figures.get(name))}, {how} {limit} wanted" for name, (how, limit) in row.limits.items()
            if figures.get(name) is None or not COMPARE[how](figures[name], limit)]


def measure_of(row):
    """The function that the row names."""
    return getattr(meeting if hasattr(meeting, row.measure) else measures, row.measure)


def run(row, options, contestant, transport):
    radio = pathlib.Path(options.programs) / "radio"
    with radio_field.RadioField(radio, measures.nodes_of(row), row.medium) as ground:
        fleet = measures.Fleet(ground, options.programs, contestant, transport, options.keys, options.budget)
        arguments = {name: min(value, options.cut) if options.cut and name in ("settle_s", "seconds", "for_s") else value
                     for name, value in row.options.items()}
        figures = measure_of(row)(fleet, **arguments)
        if ground.overrun():
            raise AssertionError("the radio was too slow for this machine: the figures would mean nothing")
        return figures


def text(value):
    if value is None:
        return "never"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}"
    return str(value)


def table(results):
    """Markdown: one table for each kind of measure, since each has its own figures."""
    lines = []
    for measure in dict.fromkeys(result["measure"] for result in results):
        chosen = [result for result in results if result["measure"] == measure]
        columns = list(dict.fromkeys(name for result in chosen for name in result["figures"]))
        titles = [name.replace("_pct", ", %").replace("kB_s", "kB/s").replace("_", " ") for name in columns]
        lines += ["", "| " + " | ".join(["what", "program", *titles, "missed"]) + " |", "|---" * (len(columns) + 3) + "|"]
        for result in chosen:
            cells = [text(result["figures"].get(name)) if name in result["figures"] else "" for name in columns]
            lines.append("| " + " | ".join([result["row"], result["program"], *cells, "; ".join(result["missed"])]) + " |")
    return "\n".join(lines[1:]) + "\n"


def heading():
    root = pathlib.Path(__file__).resolve().parents[3]
    commit = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"], stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL, text=True, check=False).stdout.strip() or "unknown"
    now = datetime.datetime.now(datetime.timezone.utc)
    return (f"{now:%Y-%m-%d %H:%M} UTC, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, commit {commit}. "
            "Bytes are whole Ethernet frames, those of `ip` figures IP packets.\n")


def write(path, results):
    begin = heading()
    pathlib.Path(path + ".json").write_text(json.dumps({"heading": begin, "results": results}, indent=1) + "\n")
    pathlib.Path(path + ".md").write_text("# Fleets on thin radios\n\n" + begin + "\n" + table(results))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", action="append")
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--cut", type=float)
    parser.add_argument("--transports", default="fastdds,cyclonedds")
    parser.add_argument("--keys", action="store_true")
    parser.add_argument("--budget", help="`auto`, or bytes a second")
    parser.add_argument("--output")
    parser.add_argument("--judge", action="store_true")
    parser.add_argument("programs")
    options = parser.parse_args()
    chosen = [row for row in rows.ROWS if any(part in row.name for part in options.only or [""])
              and (options.long or options.cut or not row.long)]
    if not chosen:
        parser.error(f"no row has {options.only} in its name" + ("" if options.long else "; try --long"))
    results = []
    with field.skipping():
        for row in chosen:
            for contestant in ([PLAIN] if row.plain and not options.keys else []) + [RABIT]:
                for transport in options.transports.split(","):
                    by_hand = pathlib.Path(options.programs) / f"bench_raw_{transport}"
                    if contestant == PLAIN and not by_hand.exists():
                        print(f"{row.name}: {by_hand.name} is not built, and left out")
                        continue
                    figures = run(row, options, contestant, transport)
                    wrong = missed(row, figures) if contestant == RABIT else []
                    results.append({"row": row.name, "measure": row.measure, "figures": figures, "missed": wrong,
                                    "program": f"{contestant}, {NAMES[transport]}"})
                    print(f"{row.name}: {results[-1]['program']}: "
                          + ", ".join(f"{name} {text(value)}" for name, value in figures.items()), flush=True)
                    if options.output:
                        write(options.output, results)
    print("\n" + table(results))
    sys.exit(1 if options.judge and any(result["missed"] for result in results) else 0)


if __name__ == "__main__":
    main()
