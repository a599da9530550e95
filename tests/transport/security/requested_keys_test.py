#!/usr/bin/env python3
"""A node that made its private key itself, and a node whose key the authorities made, exchange telemetry and queue
messages, in every pair of backends. The keys of the authorities are encrypted.

Usage: requested_keys_test.py RABIT NODE TRANSPORT..."""

import os
import pathlib
import re
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
from interop_keys import CONFIG, run  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
ORDERS = 100
NAMES = ("asking", "given")


class Fleet:
    """`asking` makes a request in the folder `there`; `given` gets its private key."""

    def __init__(self, programs, transports, domain):
        self.rabit, self.node = programs
        self.transports, self.domain = dict(zip(NAMES, transports)), domain
        self.failure = None

    def __str__(self):
        return ", ".join(f"{name} over {transport}" for name, transport in self.transports.items())

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                self.folder = pathlib.Path(folder)
                self.make_keys()
                self.exchange(processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def make_keys(self):
        fleet = self.folder / "keys"
        run([self.rabit, "keys", "init", fleet])
        configs = {}
        for name, transport in self.transports.items():
            configs[name] = self.folder / f"{name}.yaml"
            configs[name].write_text(CONFIG.format(name=name, transport=transport, domain=self.domain))
        run([self.rabit, "keys", "request", "asking", "--to", self.folder / "there"])
        run([self.rabit, "keys", "sign", self.folder / "there" / "asking.request.pem", "--keys", fleet, "--config",
             configs["asking"]])
        run([self.rabit, "keys", "add", "given", "--keys", fleet, "--config", configs["given"]])
        for file in (fleet / "asking").iterdir():
            shutil.copy(file, self.folder / "there")

    def exchange(self, processes):
        keys = {"asking": self.folder / "there", "given": self.folder / "keys" / "given"}
        nodes = [processes.start([self.node, "--node", name, "--other", other, "--transport", self.transports[name],
                                  "--domain", self.domain, "--interface", "127.0.0.1", "--count", ORDERS, "--no-frame",
                                  "--keys", keys[name]])
                 for name, other in (NAMES, reversed(NAMES))]
        for node in nodes:
            node.wait_for(re.compile(r"mirror life=\d+").fullmatch, LIMIT_S)
            node.wait_for(re.compile(f"orders life=\\d+ round=1 count={ORDERS} skipped=0").fullmatch, LIMIT_S)
            node.wait_for(re.compile(f"settled round=1 delivered={ORDERS} in_doubt=0").fullmatch, LIMIT_S)


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    os.environ["RABIT_KEYS_PASSPHRASE"] = "open sesame"
    pairs = [(asking, given) for asking in transports for given in transports]
    fleets = [Fleet(programs, pair, (harness.domain() + 7 * i) % 200) for i, pair in enumerate(pairs)]
    harness.run_at_once(fleets)
    for fleet in fleets:
        print(f"{fleet}: {fleet.failure or 'they talk'}")
    sys.exit(1 if any(fleet.failure for fleet in fleets) else 0)


if __name__ == "__main__":
    main()
