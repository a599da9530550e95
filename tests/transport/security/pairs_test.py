#!/usr/bin/env python3
"""Fresh fleets with keys, in every pair of backends: one node gets its keys from the program `rabit`, the other one makes them
and has them signed. They exchange telemetry, a State of 4 MB each, and queue messages, once and in order.

Usage: pairs_test.py RABIT NODE FLEETS TRANSPORT...
NODE is ../interop's. FLEETS: how many fresh fleets for each pair."""

import pathlib
import re
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "interop"), str(HERE.parents[1] / "integration")]
import field  # noqa: E402
import harness  # noqa: E402
import interop_keys  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
ORDERS = 100
NAMES = ("first", "second")
WRONG = re.compile("not in order|skipped round|in doubt|garbled|^lost")


class Fleet:
    """Two nodes of a fleet of their own. `nodes`: how each is started, without its options."""

    def __init__(self, rabit, nodes, transports, domain):
        self.rabit, self.nodes, self.transports, self.domain = rabit, nodes, transports, domain
        self.failure = None

    def make_keys(self, folder):
        """Returns the folder of each node."""
        keys = interop_keys.make(self.rabit, folder, NAMES[:1])
        own = folder / "own"
        field.run(self.rabit, "keys", "request", NAMES[1], "--to", own)
        field.run(self.rabit, "keys", "sign", own / f"{NAMES[1]}.request.pem", "--keys", folder / "keys", "--config",
                  interop_keys.configure(folder, NAMES[1]))
        for file in (folder / "keys" / NAMES[1]).iterdir():
            shutil.copy(file, own)
        return [keys[NAMES[0]], own]

    def start(self, processes, keys, index):
        return processes.start([*self.nodes[index], "--node", NAMES[index], "--other", NAMES[1 - index], "--transport",
                                self.transports[index], "--domain", self.domain, "--interface", "127.0.0.1", "--count", ORDERS,
                                "--keys", keys[index]])

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                keys = self.make_keys(pathlib.Path(folder))
                self.exchange([self.start(processes, keys, index) for index in (0, 1)])
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    @staticmethod
    def exchange(nodes):
        for node in nodes:
            for line in ("peer UP", r"mirror life=\d+", f"orders life=\\d+ round=1 count={ORDERS} skipped=0",
                         f"settled round=1 delivered={ORDERS} in_doubt=0", r"frame life=\d+"):
                node.wait_for(re.compile(line).fullmatch, LIMIT_S)
        for node in nodes:
            wrong = [text for _, text in node.lines if WRONG.search(text)]
            if node.terminate() != 0 or wrong:
                raise AssertionError(f"{node.argv} did not end well, or said {wrong[:3]}")


def main():
    rabit, node, count, transports = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    harness.enter_namespace()
    pairs = [(first, second) for first in transports for second in transports]
    failures = []
    for _ in range(count):
        row = [Fleet(rabit, ([node], [node]), pair, (harness.domain() + 7 * i) % 200) for i, pair in enumerate(pairs)]
        harness.run_at_once(row)
        failures += [f"{fleet.transports}: {fleet.failure}" for fleet in row if fleet.failure]
    print(f"{count * len(pairs)} fleets, {len(failures)} failed")
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
