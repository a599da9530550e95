#!/usr/bin/env python3
"""Fresh fleets with keys, in every pair of backends: the keys are made by the program `rabit`, and two nodes exchange
telemetry, a state of 4 MB and queue messages, at either level.

Usage: secured_pairs_test.py RABIT NODE FLEETS TRANSPORT...
FLEETS: how many fresh fleets for each pair and level."""

import pathlib
import re
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
from interop_keys import make_keys  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
ORDERS = 100

class Fleet:
    """Two nodes of a fleet of their own. `nodes`: how each is started, without its options."""

    def __init__(self, rabit, nodes, transports, level, domain):
        self.rabit, self.nodes, self.transports, self.level, self.domain = rabit, nodes, transports, level, domain
        self.failure = None

    def start(self, processes, folder, index):
        names = ("first", "second")
        argv = [*self.nodes[index], "--node", names[index], "--other", names[1 - index], "--transport", self.transports[index],
                "--domain", self.domain, "--interface", "127.0.0.1", "--count", ORDERS, "--keys",
                folder / "keys" / names[index]]
        return processes.start(argv + (["--sign"] if self.level == "sign" else []))

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                make_keys(self.rabit, pathlib.Path(folder), zip(("first", "second"), self.transports), self.domain)
                self.exchange(processes, pathlib.Path(folder))
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def exchange(self, processes, folder):
        nodes = [self.start(processes, folder, index) for index in (0, 1)]
        for node in nodes:
            node.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
            node.wait_for(re.compile(r"mirror life=\d+").fullmatch, LIMIT_S)
            node.wait_for(re.compile(f"orders life=\\d+ round=1 count={ORDERS} skipped=0").fullmatch, LIMIT_S)
            node.wait_for(re.compile(f"settled round=1 delivered={ORDERS} in_doubt=0").fullmatch, LIMIT_S)
            node.wait_for(re.compile(r"frame life=\d+").fullmatch, LIMIT_S)
        for node in nodes:
            if node.terminate() != 0:
                raise AssertionError(f"{node.argv} did not end well")


def main():
    rabit, node, count, transports = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    harness.enter_namespace()
    pairs = [(first, second) for first in transports for second in transports]
    failures = []
    fleets = 0
    for _ in range(count):
        for level in ("encrypt", "sign"):
            row = [Fleet(rabit, ([node], [node]), pair, level, (harness.domain() + 7 * i) % 200) for i, pair in enumerate(pairs)]
            threads = [threading.Thread(target=fleet.run) for fleet in row]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            fleets += len(row)
            failures += [f"{fleet.transports} {level}: {fleet.failure}" for fleet in row if fleet.failure]
    print(f"{fleets} fleets, {len(failures)} failed")
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
