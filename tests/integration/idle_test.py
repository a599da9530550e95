#!/usr/bin/env python3
"""What a fleet says that has nothing to say, each node with an interface of its own: at most 0.3 kB/s for each node and
0.02 kB/s for each two of them, one way and the other; with a budget 0.1 kB/s for each node. Prints a line for each
size.

Usage: idle_test.py LEDGER_NODE TRANSPORT,... BUDGET SIZE...    BUDGET: bytes a second, or none"""

import pathlib
import sys
import time

import field
import growth

FOR_NODE, FOR_PAIR, WITH_BUDGET = 300, 20, 100  # bytes a second
ETHERNET = 14  # the header, which is not IP's
# A slow machine is slow for a while. The law is for steady traffic, so one of several windows must keep it.
WINDOW_S = 20
WINDOWS = 5
# The nodes must send something: beats come twice a second, with a budget each 5 s, and some may come
# late.
FEWEST, FEWEST_WITH_BUDGET = WINDOW_S, WINDOW_S // 10


def law(size, budget):
    return WITH_BUDGET * size if budget else FOR_NODE * size + FOR_PAIR * size * (size - 1)


def sent(ground, nodes):
    """For each node: datagrams and bytes so far."""
    def read(node, name):
        return int(field.run_in(ground.space(node), "cat", f"/sys/class/net/eth0/statistics/{name}"))
    return [(read(node, "tx_packets"), read(node, "tx_bytes")) for node in nodes]


def window(ground, nodes):
    """Bytes a second of the whole fleet, and how many datagrams the most silent node sent."""
    before, began = sent(ground, nodes), time.monotonic()
    time.sleep(WINDOW_S)
    after, seconds = sent(ground, nodes), time.monotonic() - began
    packets = [b[0] - a[0] for a, b in zip(before, after)]
    size = sum(b[1] - a[1] for a, b in zip(before, after)) - ETHERNET * sum(packets)
    return size / seconds, min(packets)


def check(program, transport, budget, size):
    nodes = ["ground"] + [f"uav{k}" for k in range(1, size)]
    with field.Field(nodes) as ground:
        for node in nodes:
            ledger = pathlib.Path(ground.folder, node + ".ledger")
            ground.start(node, [program, "--node", node, "--ledger", ledger, "--transport", transport]
                         + (["--budget", budget] if budget else []))
        growth.seconds_until_all_seen(ground, nodes)
        seen = []
        for _ in range(WINDOWS):
            rate, fewest = window(ground, nodes)
            least = FEWEST_WITH_BUDGET if budget else FEWEST
            assert fewest >= least, f"{transport}, {size} nodes: one sent {fewest} datagrams in {WINDOW_S} s"
            seen.append(rate)
            if rate <= law(size, budget):
                break
    print(f"{transport}, {size} nodes{f', budget {budget} B/s' if budget else ''}: "
          f"{', '.join(f'{rate:.0f}' for rate in seen)} B/s, allowed {law(size, budget)}", flush=True)
    return seen[-1] <= law(size, budget)


def main():
    program, transports, budget, *sizes = sys.argv[1:]
    budget = None if budget == "none" else budget
    with field.skipping():
        held = [check(program, transport, budget, int(size)) for transport in transports.split(",") for size in sizes]
    return 0 if all(held) else 1


if __name__ == "__main__":
    sys.exit(main())
