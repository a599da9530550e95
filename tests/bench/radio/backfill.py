#!/usr/bin/env python3
"""What was missed, over a slow radio: how long it takes, what it costs live values and commands, and how a file comes
through cuts and kills. gateway/backfill has what is measured. Needs root.

Usage: backfill.py PROGRAMS TRANSPORT [--budget RATE] [fill|fetch]...

    build/release/bin holds the programs: ninja -C build/release backfill_node backfill_judge rabit radio"""

import argparse
import hashlib
import json
import pathlib
import random
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "gateway" / "backfill"))
import backfill_fleet as bf  # noqa: E402
import radio_field  # noqa: E402  (backfill_fleet finds tests/integration)

KBIT = 250
AIRCRAFT = [f"uav{number}" for number in range(1, 5)]
RATE_HZ = 5
PADDING = 100
CUT_S = 60
FILE = 10_000_000
CUTS = 10


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def shown(process, begin, end):
    """Ages, and how long commands took that were sent and delivered in that time, in seconds."""
    lines = [(when, text.split()) for when, text in list(process.lines) if begin <= when < end]
    ages = [float(words[2]) for _, words in lines if words and words[0] == "age"]
    commands = [float(words[-1]) for when, words in lines
                if words and words[0] == "command" and words[2] == "delivered" and when - float(words[-1]) >= begin]
    return ages, commands


def medium():
    return {"kbit": KBIT, "queue": 16000, "static_neighbours": True}


def fill(programs, transport, more):
    with radio_field.RadioField(programs / "radio", ["ground", *AIRCRAFT], medium()) as ground:
        fleet = bf.Fleet(ground, programs, transport, ground.folder)
        for node in ground.nodes:
            fleet.write(node, more)
        station = fleet.start("ground")
        for node in AIRCRAFT:
            fleet.start(node, "--rate", str(RATE_HZ), "--padding", str(PADDING))
        for node in AIRCRAFT:
            station.wait_for(lambda text, node=node: text.startswith(f"age {node}"), bf.LIMIT)
        time.sleep(20)
        fleet.wait_until_whole_so_far(AIRCRAFT, bf.LIMIT)
        before = time.monotonic()
        time.sleep(60)
        calm = shown(station, before, time.monotonic())
        ground.outage("on")
        time.sleep(CUT_S)
        ground.outage("off")
        healed = time.monotonic()
        ground.reset()
        for node in AIRCRAFT:
            station.wait_for(lambda text, node=node: text.startswith(f"age {node}") and float(text.split()[2]) < 2,
                             bf.LIMIT, healed)
        live = time.monotonic()
        figures = fleet.wait_until_whole_so_far(AIRCRAFT, 600)
        whole = time.monotonic()
        busy = shown(station, live, whole)
        air = ground.counters()
        posted, twice, other, backfilled = (sum(row[key] for row in figures)
                                            for key in ("posted", "twice", "other_bytes", "backfilled"))
        print(f"| {transport} | {live - healed:.1f} s | {whole - healed:.1f} s | {posted} | {backfilled} | {twice} | {other} | "
              f"{max(row['worst_time_ms'] for row in figures):.0f} ms | "
              f"{1000 * percentile(calm[0], .9):.0f} / {1000 * percentile(busy[0], .9):.0f} ms | "
              f"{1000 * percentile(calm[1], .99):.0f} / {1000 * percentile(busy[1], .99):.0f} ms | "
              f"{1000 * statistics.median(calm[1]):.0f} / {1000 * statistics.median(busy[1]):.0f} ms | "
              f"{100 * air['utilisation']:.0f} % |", flush=True)


def fetch(programs, transport, more):
    with radio_field.RadioField(programs / "radio", ["ground", "uav1"], medium()) as ground:
        fleet = bf.Fleet(ground, programs, transport, ground.folder)
        fleet.write("uav1", more)
        original = fleet.files("uav1") / "map.bin"
        original.write_bytes(random.Random(1).randbytes(FILE))
        fleet.start("uav1", "--rate", "1")
        to = fleet.folder / "map.bin"
        part = fleet.folder / "map.bin.part"

        def start():
            return ground.start("tool", [programs / "rabit", "fetch", "uav1:map.bin", "--to", to, "--json", "--transport",
                                         transport, "--domain", "0", "--interface", ground.address("ground"), "--wait",
                                         "60"], "ground")

        def until_has(share):
            bf.harness.until(lambda: to.exists() or part.exists() and part.stat().st_size >= share * FILE, 1200)

        tool = start()
        until_has(0.01)
        begin = time.monotonic()
        have = part.stat().st_size
        down = 0.0
        sent = used = seconds = 0
        ground.reset()
        for cut in range(1, CUTS + 1):
            until_has(cut / (CUTS + 2))
            air = ground.counters()
            sent, used, seconds = (sent + air["sent"]["bytes"], used + air["utilisation"] * air["seconds"],
                                   seconds + air["seconds"])
            ground.outage("on")
            time.sleep(3)
            ground.outage("off")
            ground.reset()
            down += 3
            if cut == 3:
                tool.kill()
                tool = start()
            if cut == 7:
                ground.kill("uav1")
                fleet.start("uav1", "--rate", "1")
        until_has(1.01)
        code = tool.exit_code(bf.LIMIT)
        took = time.monotonic() - begin
        air = ground.counters()
        sent, used, seconds = (sent + air["sent"]["bytes"], used + air["utilisation"] * air["seconds"],
                               seconds + air["seconds"])
        assert code == 0, tool.lines[-5:]
        equal = hashlib.sha256(to.read_bytes()).digest() == hashlib.sha256(original.read_bytes()).digest()
        told = json.loads(tool.lines[-1][1])
        print(f"| {transport} | {took:.0f} s | {down:.0f} s | {100 * used / seconds:.0f} % | "
              f"{100 * (FILE - have) * 8 / (KBIT * 1000) / (took - down):.0f} % | {sent / (FILE - have):.3f} | "
              f"{100 * told['repeated_bytes'] / FILE:.2f} % | {'yes' if equal else 'NO'} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("transport")
    parser.add_argument("cases", nargs="*", default=["fill", "fetch"])
    parser.add_argument("--budget")
    arguments = parser.parse_args()
    more = f"radio: {{budget: {arguments.budget}}}\n" if arguments.budget else ""
    for case in arguments.cases:
        {"fill": fill, "fetch": fetch}[case](arguments.programs.absolute(), arguments.transport, more)


if __name__ == "__main__":
    main()
