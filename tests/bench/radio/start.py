#!/usr/bin/env python3
"""How long nodes that start at once need to find each other on a radio, without keys and with them: until all saw all others UP.

Usage: start.py [--nodes N] [--kbit RATE]... [--loss PERCENT] [--tries N] [--transports NAME,...] [--levels NAME,...]
                [--limit SECONDS] PROGRAMS
`--levels` has `none`, `keys` or both: nodes without keys and with them. PROGRAMS is the folder of the programs (build/release/bin).
Each node publishes a tick a second, which all others follow. Exit code 77: this machine does not allow it."""

import argparse
import pathlib
import sys
import tempfile
import time

import measures
from rows import MIXED, RABIT

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402
import fleet_keys  # noqa: E402
import radio_field  # noqa: E402

LEVELS = ("none", "keys")


def start(options, transport, level, kbit):
    programs = pathlib.Path(options.programs)
    nodes = [f"uav{number}" for number in range(1, options.nodes + 1)]
    with tempfile.TemporaryDirectory() as folder, \
            radio_field.RadioField(programs / "radio", nodes, {"kbit": kbit, "loss": options.loss}) as ground:
        fleet = measures.Fleet(ground, programs, RABIT, transport)
        keys = fleet_keys.make(programs / "rabit", folder, nodes) if level == "keys" else {}
        ground.reset()
        began = time.monotonic()
        for node in nodes:
            fleet.start_ledger(node, "--ticks", "--tick-period-ns", 1_000_000_000, *fleet_keys.arguments(keys, node))
        up = fleet.wait_until_all_up(options.limit)
        took, counters = time.monotonic() - began, ground.counters()
        dropped = sum(each["dropped"]["bytes"] for each in counters["nodes"].values())
        offered = sum(each["offered"]["bytes"] for each in counters["nodes"].values())
        wait = max(each["longest_wait_ms"] for each in counters["nodes"].values())
        time.sleep(options.settle)
        ground.reset()
        time.sleep(options.settle)
        idle = ground.counters()["sent"]["ip_bytes"] / options.settle
        pairs = {(node, event["node"]) for node, lives in fleet.ledgers().lives.items() for life in lives
                 for event in life.of("peer") if event["state"] == "UP"}
        found = 100 * len(pairs) / (options.nodes * (options.nodes - 1))
        peers = [event for life in fleet.ledgers().all_lives() for event in life.of("peer")]
        lost = sum(event["state"] in ("STALE", "LOST") for event in peers)
        print(f"| {measures_name(transport)} | {level} | {kbit} | {'never' if up is None else f'{up:.1f}'} | {found:.0f} | "
              f"{counters['sent']['ip_bytes'] / 1e6:.2f} | {took:.1f} | {100 * dropped / max(offered, 1):.0f} | {wait:.0f} | "
              f"{lost} | {idle / 1000:.1f} |", flush=True)


def measures_name(transport):
    return {"fastdds": "Fast DDS", "cyclonedds": "Cyclone DDS", MIXED: "both in turns"}[transport]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--nodes", type=int, default=10)
    parser.add_argument("--kbit", type=float, action="append")
    parser.add_argument("--transports", default="fastdds,cyclonedds")
    parser.add_argument("--levels", default=",".join(LEVELS))
    parser.add_argument("--loss", type=float, default=0, help="percent, at each receiver")
    parser.add_argument("--tries", type=int, default=1)
    parser.add_argument("--limit", type=float, default=120)
    parser.add_argument("--settle", type=float, default=10, help="seconds, before and while the idle fleet is measured")
    parser.add_argument("programs")
    options = parser.parse_args()
    if not set(options.levels.split(",")) <= set(LEVELS):
        parser.error(f"the levels are {' and '.join(LEVELS)}")
    print(f"{options.nodes} nodes at once\n\n| backend | keys | kbit/s | all UP, s | found, % | IP MB until then | in, s | dropped by queues, % | "
          "longest in a queue, ms | STALE, LOST | then, kB/s |\n|---|---|---|---|---|---|---|---|---|---|---|")
    with field.skipping():
        for kbit in options.kbit or [1000]:
            for transport in options.transports.split(","):
                for level in options.levels.split(",") * options.tries:
                    start(options, transport, level, kbit)


if __name__ == "__main__":
    main()
