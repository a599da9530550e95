#!/usr/bin/env python3
"""How a fleet grows that publishes nothing, each node with an interface of its own: for each size the time until
everyone sees everyone, and what one node costs. Prints a row of README.md's table for each size. Fleets that publish,
beside plain DDS: tests/bench/run.sh --part fleet.

Usage: growth.py LEDGER_NODE TRANSPORT SIZE..."""

import os
import pathlib
import statistics
import sys
import time

import field
import judge

MEASURED_S = 15
SETTLE_S = 3
LIMIT_S = 120
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def costs(ground, nodes):
    """For each node: processor seconds, bytes sent, bytes received so far."""
    rows = []
    for node in nodes:
        fields = pathlib.Path(f"/proc/{ground.processes[node].pid}/stat").read_text().rpartition(")")[2].split()
        rows.append(((int(fields[11]) + int(fields[12])) / TICKS_PER_S, *ground.traffic(node)))
    return rows


def memory_mib(ground, nodes):
    rows = []
    for node in nodes:
        status = pathlib.Path(f"/proc/{ground.processes[node].pid}/status").read_text()
        rows.append(int(status.partition("VmRSS:")[2].split()[0]) / 1024)
    return statistics.mean(rows)


def ledger(ground, node):
    return pathlib.Path(ground.folder, node + ".ledger")


def seconds_until_all_seen(ground, nodes):
    """From the start of the last node until the last one has seen all others UP, by the ledgers' clock."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        lives = [judge.read_ledger(ledger(ground, node).read_text()) if ledger(ground, node).exists() else []
                 for node in nodes]
        ups = [[e.time for e in life[0].of("peer") if e["state"] == "UP"] if life else [] for life in lives]
        if all(len(up) >= len(nodes) - 1 for up in ups):
            start = max(life[0].begin for life in lives)
            return (max(up[len(nodes) - 2] for up in ups) - start) * 1e-9
        time.sleep(0.5)
    raise AssertionError(f"not all see all within {LIMIT_S} s")


def measure(program, transport, size):
    nodes = ["ground"] + [f"uav{k}" for k in range(1, size)]
    with field.Field(nodes) as ground:
        for node in nodes:
            ground.start(node, [program, "--node", node, "--ledger", ledger(ground, node), "--transport", transport])
        seen = seconds_until_all_seen(ground, nodes)
        time.sleep(SETTLE_S)
        before, began = costs(ground, nodes), time.monotonic()
        time.sleep(MEASURED_S)
        after, seconds = costs(ground, nodes), time.monotonic() - began
        mean = [statistics.mean(b[i] - a[i] for a, b in zip(before, after)) / seconds for i in range(3)]
        return seen, 100 * mean[0], mean[1] / 1000, mean[2] / 1000, memory_mib(ground, nodes)


def main():
    program, transport, *sizes = sys.argv[1:]
    print("| nodes | all see all, s | processor of a node, % | sent, kB/s | received, kB/s | memory, MiB |")
    print("|---|---|---|---|---|---|")
    for size in map(int, sizes):
        seen, processor, sent, received, memory = measure(program, transport, size)
        print(f"| {size} | {seen:.1f} | {processor:.1f} | {sent:.1f} | {received:.1f} | {memory:.0f} |", flush=True)


if __name__ == "__main__":
    main()
