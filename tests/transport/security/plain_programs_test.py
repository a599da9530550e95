#!/usr/bin/env python3
"""Programs of the vendors' own, without keys, of which one writes and one reads a topic of members: they hear nothing and are
not heard. Beside nodes without keys they hear, and are.

Usage: plain_programs_test.py ODD_KEYS PEER TRANSPORT,... PROGRAM...
ODD_KEYS and PEER are programs of this folder, PROGRAMs of ../../foreign."""

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
QOS = "string:best_effort:volatile"


class Case:
    """A plain program beside two nodes, with keys or without."""

    def __init__(self, programs, program, transports, level, domain):
        self.odd_keys, self.peer = programs
        self.program, self.transports, self.level, self.domain = program, transports, level, domain
        self.failure = None
        self.said = []

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                self.meet(processes, pathlib.Path(folder) / "fleet")
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def start(self, processes, fleet, node, transport):
        keys = ["-", "encrypt"]
        if self.level != "none":
            subprocess.run([self.odd_keys, "add", fleet, node, transport, str(self.domain), "0", "365"], check=True)
            keys = [fleet / node, self.level]
        return processes.start([self.peer, transport, node, self.domain, *keys, "lo", 10, "words"])

    def meet(self, processes, fleet):
        if self.level != "none":
            subprocess.run([self.odd_keys, "init", fleet, "blue"], check=True)
        writer, plain = [processes.start([self.program, self.domain, f"{way}:State:{QOS}"]) for way in ("write", "read")]
        for each in (writer, plain):
            each.wait_for(re.compile("ready").fullmatch, LIMIT_S)
        names = {f"member{i}": transport for i, transport in enumerate(self.transports)}
        nodes = {name: self.start(processes, fleet, name, transport) for name, transport in names.items()}
        for name, node in nodes.items():
            for other in names.keys() - {name}:
                node.wait_for(re.compile(f"heard {other} 20").fullmatch, LIMIT_S)
            self.said += sorted({f"{names[name]}: {text}" for _, text in node.lines if text.startswith("log")
                                 and not text.endswith("so far)")})
            if self.level == "none":
                node.wait_for(re.compile("heard nobody 1").fullmatch, LIMIT_S)
                plain.wait_for(re.compile(f"got State {name}").fullmatch, LIMIT_S)
            elif any(re.match("(heard|said) nobody", text) for _, text in node.lines):
                raise AssertionError(f"a member over {names[name]} heard it")
        heard = [text for _, text in plain.lines if "member" in text]
        if self.level != "none" and heard:
            raise AssertionError(f"it heard members: {heard}")


def main():
    programs, transports, plain = sys.argv[1:3], sys.argv[3].split(","), sys.argv[4:]
    harness.enter_namespace()
    cases = [Case(programs, program, transports, level, harness.domain() + 3 * (len(plain) * i + j))
             for i, level in enumerate(("none", "sign", "encrypt")) for j, program in enumerate(plain)]
    harness.run_at_once(cases)
    for case in cases:
        print(f"{pathlib.Path(case.program).name}, {case.level}: {case.failure or 'as it should be'}")
        for line in case.said:
            print(f"    {line}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
