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
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
# Nodes meet within this time and what they wait for a processor (harness.Waits). A certificate lasts longer. If the machine
# takes so much that one ends before that, the next one is taken.
MEET_S = 20
LIVES_S = (60, 180)
A_YEAR = 365


class TooSlow(Exception):
    """The machine took so much that the certificate ended before the nodes had to have met."""


class Case:
    """A node with a short life over one backend, among members over both."""

    def __init__(self, programs, transport, domain):
        self.odd_keys, self.peer = programs
        self.transport, self.domain = transport, domain
        self.failure = None

    def run(self):
        for life_s in LIVES_S:
            try:
                with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                    self.fly(processes, pathlib.Path(folder) / "fleet", life_s)
                self.failure = None
                return
            except TooSlow as error:
                self.failure = harness.reason(error)
            except Exception as error:  # the other goes on
                self.failure = harness.reason(error)
                return

    def fly(self, processes, fleet, life_s):
        end = time.monotonic() + life_s
        subprocess.run([self.odd_keys, "init", fleet, "blue"], check=True)
        nodes = {"fast": "fastdds", "cyclone": "cyclonedds", "short": self.transport}
        for name, transport in nodes.items():
            begins = life_s / 86400 - A_YEAR if name == "short" else 0
            subprocess.run([self.odd_keys, "add", fleet, name, transport, str(self.domain), str(begins), str(A_YEAR)],
                           check=True)
        running = {name: processes.start([self.peer, transport, name, self.domain, fleet / name, "encrypt"])
                   for name, transport in nodes.items()}
        with harness.Waits(processes.pids) as waits:
            self.meet(running, waits, end)
        gone, _ = running["cyclone"].wait_for(re.compile("gone short").fullmatch, LIMIT_S)
        running["fast"].wait_for(re.compile(r"heard short \d+").fullmatch, LIMIT_S, gone)
        heard, _ = running["fast"].wait_for(re.compile(r"heard cyclone \d+").fullmatch, LIMIT_S, gone)
        running["cyclone"].wait_for(re.compile(r"heard fast \d+").fullmatch, LIMIT_S, heard)
        late = [text for when, text in running["cyclone"].lines if when > gone + 1 and text.startswith("heard short")]
        if late:
            raise AssertionError(f"a member over Cyclone DDS still hears it: {late}")

    @staticmethod
    def meet(running, waits, end):
        """Waits until all have heard each other, until the certificate ends."""
        begin = time.monotonic()
        for name, process in running.items():
            for other in running.keys() - {name}:
                try:
                    when, _ = process.wait_for(re.compile(f"heard {other} 1").fullmatch, max(end - time.monotonic(), 0))
                except AssertionError as error:
                    when = time.monotonic()
                    if when >= end and end - begin - waits.between(begin, end) <= MEET_S:
                        raise TooSlow(f"{name} did not hear {other} within {end - begin:.0f} s") from error
                    raise
                if when - begin - waits.between(begin, when) > MEET_S:
                    raise AssertionError(f"{name} heard {other} after {when - begin:.0f} s")


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
