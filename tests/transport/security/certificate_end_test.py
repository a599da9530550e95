#!/usr/bin/env python3
"""A certificate that ends while its node runs: members over Cyclone DDS lose the node at that moment, those over Fast DDS go
on to hear it; the members go on to hear each other.

Usage: certificate_end_test.py ODD_KEYS PEER
ODD_KEYS and PEER are programs of this folder."""

import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
# The certificate lasts for so long, in s: two nodes meet within a few seconds, and on a machine with much else to do later.
LIFE_S = 180
A_YEAR = 365


class Case:
    """A node with a short life over one backend, among members over both."""

    def __init__(self, programs, transport, domain):
        self.odd_keys, self.peer = programs
        self.transport, self.domain = transport, domain
        self.failure = None

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                self.fly(processes, pathlib.Path(folder) / "fleet")
        except Exception as error:  # the other goes on
            self.failure = harness.reason(error)

    def fly(self, processes, fleet):
        subprocess.run([self.odd_keys, "init", fleet, "blue"], check=True)
        nodes = {"fast": "fastdds", "cyclone": "cyclonedds", "short": self.transport}
        for name, transport in nodes.items():
            begins = LIFE_S / 86400 - A_YEAR if name == "short" else 0
            subprocess.run([self.odd_keys, "add", fleet, name, transport, str(self.domain), str(begins), str(A_YEAR)],
                           check=True)
        running = {name: processes.start([self.peer, transport, name, self.domain, fleet / name, "encrypt"])
                   for name, transport in nodes.items()}
        for name, process in running.items():
            for other in running.keys() - {name}:
                process.wait_for(re.compile(f"heard {other} 1").fullmatch, LIMIT_S)
        gone, _ = running["cyclone"].wait_for(re.compile("gone short").fullmatch, LIMIT_S)

        def heard(node, other, since):
            return running[node].wait_for(re.compile(rf"heard {other} \d+").fullmatch, LIMIT_S, since)[0] + 0.001

        heard("fast", "cyclone", gone)
        # Samples of before the end are told before those that another member sent after it.
        ended = heard("cyclone", "fast", heard("fast", "short", gone))
        heard("cyclone", "fast", heard("fast", "short", ended))
        late = [text for when, text in running["cyclone"].lines if when > ended and text.startswith("heard short")]
        if late:
            raise AssertionError(f"a member over Cyclone DDS still hears it: {late}")


def main():
    harness.enter_namespace()
    cases = [Case(sys.argv[1:3], transport, harness.domain() + 3 * i)
             for i, transport in enumerate(("fastdds", "cyclonedds"))]
    harness.run_at_once(cases)
    failures = [f"{case.transport}: {case.failure}" for case in cases if case.failure]
    print("\n".join(failures) or "as it should be")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
