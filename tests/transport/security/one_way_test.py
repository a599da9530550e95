#!/usr/bin/env python3
"""A member hears nothing of another one for longer than its lease, while the other one goes on hearing it. Both must
hear each other again once the way is open. A third member is heard all the time, and multicasts keep what the two send
from going to each other alone.

Usage: one_way_test.py ODD_KEYS PEER TRANSPORT...
ODD_KEYS and PEER are programs of this folder. Needs root."""

import pathlib
import re
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import field  # noqa: E402
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 400
LEASE_S = 4


class Case:
    """Three members in a domain of their own. The first one becomes deaf to the second one."""

    def __init__(self, programs, transports, domain):
        self.odd_keys, self.peer = programs
        self.domain, self.network = domain, None
        self.transports = {f"{name}{domain}": transport
                           for name, transport in zip(("deaf", "heard", "third"), transports)}
        self.nodes = list(self.transports)
        self.running = {}
        self.failure = None
        self.took = 0.0
        self.lines = []

    def __str__(self):
        return "+".join(self.transports.values())

    def run(self):
        try:
            self.start()
            self.meet(0.0)
            self.deafen(*self.nodes[:2])
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)
        for node, process in self.running.items():
            self.lines += [f"{when:6.1f} {node}: {text}" for when, text in process.lines
                           if not text.startswith("heard")]
            process.kill()

    def start(self):
        fleet = pathlib.Path(self.network.folder) / f"fleet{self.domain}"
        subprocess.run([self.odd_keys, "init", fleet, "blue"], check=True)
        for node, transport in self.transports.items():
            subprocess.run([self.odd_keys, "add", fleet, node, transport, str(self.domain), "0", "365"], check=True)
        for node, transport in self.transports.items():
            self.running[node] = self.network.start(
                node, [self.peer, transport, node, self.domain, fleet / node, "encrypt", "eth0", LEASE_S])

    def meet(self, since):
        for node in self.nodes:
            for other in self.nodes:
                if other != node:
                    self.running[node].wait_for(re.compile(f"heard {other} \\d+").fullmatch, LIMIT_S, since)

    def deafen(self, deaf, other):
        self.network.lose(100, [other], [deaf])
        self.running[deaf].wait_for(re.compile(f"gone {other}").fullmatch, LIMIT_S)
        self.network.lose(0, [other], [deaf])
        healed = time.monotonic()
        self.meet(healed)
        self.took = time.monotonic() - healed


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    pairs = [(one, other, one) for one in transports for other in transports]
    cases = [Case(programs, pair, domain) for domain, pair in enumerate(pairs)]
    with field.skipping():
        with field.Field([node for case in cases for node in case.nodes]) as network:
            for case in cases:
                case.network = network
            harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: {case.failure or f'heard each other again after {case.took:.0f} s'}")
        if case.failure:
            for line in sorted(case.lines):
                print(f"    {line}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
