#!/usr/bin/env python3
"""Two nodes with two networks each, a mesh and a slow modem. The mesh is cut and comes back, again and again, while one
node sends 50 commands a second: each arrives once, in order, and the gap at the receiver is short.

Usage: paths_test.py LEDGER_NODE TRANSPORTS [--cuts N] [--modem KBIT] [--budget B/s] [--keys RABIT]
TRANSPORTS: that of the mesh and that of the modem, with a comma between; one: both have it. Prints the gap at each cut, and how many bytes each
network carried while both were there. Exit code 77: this machine allows no namespaces."""

import argparse
import pathlib
import signal
import statistics
import sys
import time

import field
import fleet_keys
import harness
import judge

RATE = 50
LONGEST_GAP_S = 1.0  # and what the machine took
LIMIT_S = 400  # only ends a broken test
UP_S, CUT_S = 6, 4
DEVICES = {"mesh": "eth0", "modem": "eth1"}


class TwoNetworks(field.Field):
    """A field with a second network in each namespace: eth1, 10.78.0.0/16, slow."""

    def __init__(self, nodes, kbit):
        super().__init__(nodes)
        self.kbit = kbit

    def _connect(self):
        super()._connect()
        switch = ["ip", "-n", self.space("switch"), "link"]
        field.run(*switch, "add", "br1", "type", "bridge", "mcast_snooping", "0")
        field.run(*switch, "set", "br1", "up")
        for number, node in enumerate(self.nodes):
            field.run(*switch, "add", f"q{number}", "type", "veth", "peer", "name", "eth1", "netns", self.space(node))
            field.run(*switch, "set", f"q{number}", "master", "br1", "up")
            inside = ["ip", "-n", self.space(node)]
            field.run(*inside, "address", "add", f"10.78.0.{number + 1}/16", "dev", "eth1")
            field.run(*inside, "link", "set", "eth1", "up")
            field.run("tc", "-n", self.space(node), "qdisc", "replace", "dev", "eth1", "root", "tbf", "rate",
                      f"{self.kbit}kbit", "burst", "2000", "limit", "16000")

    def sent(self, node, device, what="bytes"):
        return int(field.run_in(self.space(node), "cat", f"/sys/class/net/{device}/statistics/tx_{what}"))

    def cut_network(self, *names):
        rules = "\n".join(f'  iifname "{DEVICES[name]}" drop' for name in names)
        text = f"table ip network {{\n chain arriving {{\n  type filter hook input priority 1;\n{rules}\n }}\n}}\n"
        for node in self.nodes:
            field.run_in(self.space(node), "nft", "-f", "-", text=text)

    def heal_network(self):
        for node in self.nodes:
            field.run_in(self.space(node), "nft", "delete", "table", "ip", "network")


def ledger(ground, node):
    path = pathlib.Path(ground.folder, node + ".ledger")
    return path.read_text() if path.exists() else ""


def arrivals(ground):
    """Seconds of the monotonic clock."""
    return [event.time * 1e-9 for life in judge.read_ledger(ledger(ground, "uav1")) for event in life.of("delivered")]


def wait_for(what, limit_s):
    begin = time.monotonic()
    while not what():
        assert time.monotonic() - begin < limit_s, "not within the limit"
        time.sleep(0.05)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ledger_node")
    parser.add_argument("transports")
    parser.add_argument("--cuts", type=int, default=3)
    parser.add_argument("--modem", type=float, default=1000, help="kbit/s")
    parser.add_argument("--budget", type=int, help="bytes a second on the modem")
    parser.add_argument("--keys", metavar="RABIT", help="the modem alone has keys, which this program makes")
    options = parser.parse_args()
    mesh, modem = (options.transports.split(",") * 2)[:2]
    seconds = UP_S + options.cuts * (CUT_S + UP_S)
    count = RATE * seconds
    with TwoNetworks(["ground", "uav1"], options.modem) as ground:
        keys = fleet_keys.make(options.keys, ground.folder, dict.fromkeys(ground.nodes, modem)) if options.keys else {}
        for node in ground.nodes:
            ground.start(node, [options.ledger_node, "--node", node, "--ledger", f"{ground.folder}/{node}.ledger",
                                "--path", f"mesh:{mesh}:eth0", "--path",
                                f"modem:{modem}:eth1:{options.budget or ''}:{keys.get(node, '')}".rstrip(":"),
                                *(["--to", "uav1", "--count", count, "--rate", RATE, "--capacity", 5000,
                                   "--payload", 50] if node == "ground" else [])])
        waits = harness.Waits(ground.pids)
        wait_for(lambda: arrivals(ground), LIMIT_S)
        time.sleep(2)
        before = {device: ground.sent("ground", device) for device in ("eth0", "eth1")}
        time.sleep(UP_S - 2)
        both = {device: ground.sent("ground", device) - before[device] for device in before}
        print(f"both are there: mesh {both['eth0'] / (UP_S - 2) / 1000:.1f} kB/s, modem {both['eth1'] / (UP_S - 2) / 1000:.2f} kB/s")
        cuts = []
        for _ in range(options.cuts):
            ground.lose(100)
            cuts.append(time.clock_gettime(time.CLOCK_MONOTONIC))
            time.sleep(CUT_S)
            ground.heal()
            time.sleep(UP_S)
        wait_for(lambda: len(arrivals(ground)) >= count, LIMIT_S)
        wait_for(lambda: ledger(ground, "ground").count(" outcome ") >= count, LIMIT_S)
        time.sleep(2)  # the counters in the ledger are those of the last report
        for node in ground.nodes:
            ground.signal(node, signal.SIGINT)
        wait_for(lambda: not any(process.running() for process in ground.processes.values()), LIMIT_S)
        wrong = judge.judge([ledger(ground, node) for node in ground.nodes])
        at = arrivals(ground)
    assert not wrong, "\n".join(map(str, wrong))
    gaps, wrong = [], []
    for cut in cuts:
        times = [moment for moment in at if cut - 0.5 <= moment <= cut + CUT_S]
        pairs = list(zip(times, times[1:]))
        gaps.append(max(later - earlier for earlier, later in pairs))
        wrong += [later - earlier for earlier, later in pairs
                  if later - earlier - waits.between(earlier, later) > LONGEST_GAP_S]
    overall = max(later - earlier for earlier, later in zip(at, at[1:]))
    print(f"{options.cuts} cuts: gap p50 {statistics.median(gaps) * 1000:.0f} ms, worst {max(gaps) * 1000:.0f} ms; "
          f"longest of all {overall * 1000:.0f} ms; {len(at)} of {count} commands, each once and in order")
    assert not wrong, wrong


if __name__ == "__main__":
    with field.skipping():
        main()
