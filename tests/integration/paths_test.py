#!/usr/bin/env python3
"""Two nodes with two networks each, a mesh and a slow modem. The mesh is cut and comes back, again and again, while one
node sends commands: all that are sent while it is cut arrive by the modem, each once and in order. The times are judged by
tests/gateway/PathsTest.cpp.

Usage: paths_test.py LEDGER_NODE TRANSPORTS [--cuts N] [--modem KBIT] [--budget B/s] [--keys RABIT]
TRANSPORTS: that of the mesh and that of the modem, with a comma between; one: both have it.
Exit code 77: this machine allows no namespaces."""

import argparse

import field
import fleet_keys
import judge
import run_scenario

COMMANDS = 100  # while the mesh is there, and while it is cut, each time
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


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("ledger_node")
    parser.add_argument("transports")
    parser.add_argument("--cuts", type=int, default=3)
    parser.add_argument("--modem", type=float, default=1000, help="kbit/s")
    parser.add_argument("--budget", type=int, help="bytes a second on the modem")
    parser.add_argument("--keys", metavar="RABIT", help="the nodes have keys, which this program makes")
    options = parser.parse_args()
    mesh, modem = (options.transports.split(",") * 2)[:2]
    with TwoNetworks(["ground", "uav1"], options.modem) as ground:
        keys = fleet_keys.make(options.keys, ground.folder, ground.nodes) if options.keys else {}
        paths = {node: ["--path", f"mesh:{mesh}:eth0", "--path", f"modem:{modem}:eth1:{options.budget or ''}".rstrip(":"),
                        *fleet_keys.arguments(keys, node)] for node in ground.nodes}
        paths["ground"] += ["--to", "uav1", "--orders", "--rate", "1000000", "--capacity", "5000", "--payload", "50"]
        fleet = run_scenario.Fleet(ground, options.ledger_node, None,
                                   {"nodes": paths, "transports": dict.fromkeys(ground.nodes, mesh), "stateless": ground.nodes})
        for node in ground.nodes:
            fleet.start(node)
        steps = run_scenario.Faults(fleet)
        round_of_commands = [["order", "ground", f"notes {COMMANDS}"], ["settle"]]
        try:
            steps.run([["meet"], *round_of_commands])
            steps.run([["repeat", options.cuts, [["lose", 100], *round_of_commands, ["heal"], *round_of_commands]]])
            wrong = []
        except run_scenario.NeverSeen as never:
            wrong = [f"not seen after {steps.done[-1][1:]}: {text}" for text in never.args]
        wrong += fleet.stop() + judge.judge(fleet.ledgers().values())
        delivered = fleet.counted("ground", "delivered")
    assert not wrong, "\n".join(wrong)
    print(f"{options.cuts} cuts: {delivered} commands, each once and in order")


if __name__ == "__main__":
    with field.skipping():
        main()
