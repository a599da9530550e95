#!/usr/bin/env python3
"""What a node costs that has nothing to do, beside others: processor, bytes and memory. All are processes in one
network namespace, of which each subscribes to a message of all others, and nobody posts.

Usage: idle_fleet.py [--seconds S] PROGRAMS TRANSPORT SIZE...
Prints a row for each size. The first fleet is compared with the others: what a peer adds."""

import argparse
import pathlib
import statistics
import time

import contestants
from contestants import NODE, loopback_bytes, processor_ns
from fleet import memory_mib

NEVER_NS = 10 ** 15
# Until nodes have found each other, and beat at their usual pace again.
SETTLING_S, SETTLING_OF_EACH_S = 12, 0.4


def measure(programs, transport, size, seconds):
    """Share of a processor, bytes a second, resident MiB and own MiB of a node, on average."""
    options = {"carriage": "state", "payload": 100, "members": max(size, 2), "period": NEVER_NS}
    with contestants.harness.Processes() as processes:
        pids = [processes.start(programs.argv(NODE, transport, "member", {**options, "member": member})).pid
                for member in range(1, size + 1)]
        time.sleep(SETTLING_S + SETTLING_OF_EACH_S * size)
        used, sent, began = sum(map(processor_ns, pids)), loopback_bytes(), time.monotonic()
        time.sleep(seconds)
        passed = time.monotonic() - began
        share = (sum(map(processor_ns, pids)) - used) / size / passed * 1e-9
        sent = (loopback_bytes() - sent) / size / passed
        memory = [(resident_mib(pid), memory_mib(pid)[1]) for pid in pids]
        return share, sent, *(statistics.mean(column) for column in zip(*memory))


def resident_mib(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0]) / 1024


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("transport")
    parser.add_argument("sizes", type=int, nargs="+")
    arguments = parser.parse_args()
    contestants.harness.enter_namespace()
    programs = contestants.Contestants(arguments.programs, contestants.harness.domain())
    first = None
    print("| nodes | backend | processor, % of a core | bytes a second | resident, MiB | own, MiB | each peer, kB |\n"
          "|---|---|---|---|---|---|---|")
    for size in arguments.sizes:
        share, sent, resident, own = measure(programs, arguments.transport, size, arguments.seconds)
        first = first or (size, own)
        each = f"{(own - first[1]) * 1024 / (size - first[0]):.0f}" if size > first[0] else ""
        print(f"| {size} | {arguments.transport} | {100 * share:.2f} | {sent:.0f} | {resident:.1f} | {own:.1f} | {each} |",
              flush=True)


if __name__ == "__main__":
    main()
