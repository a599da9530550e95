#!/usr/bin/env python3
"""Plain programs of each vendor beside two nodes with keys that use the same topics, types and QoS: the programs hear nothing of
the nodes and are not heard, and each node says that a program without keys is there. Beside one such node without keys they
hear, and are heard. One, since two share a group of multicast: an assertion of Fast DDS 2.9 ends a program that then sends to
the address of one of them (OutputTrafficManager.hpp:87, fixed in 2025 by its change 5704).

Usage: keys_test.py NODE RABIT TRANSPORT,... PLAIN_PROGRAM...
Skipped (exit code 77) where no network namespace can be made."""

import pathlib
import re
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import field  # noqa: E402
import fleet_keys  # noqa: E402
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
NODES = ("uav1", "uav2")
CONFIG = """node: {node}
domain: {domain}
transport: {transport}
interfaces: [127.0.0.1]
foreign:
  - {{subscribe: rt/chatter, type: std_msgs::msg::String, as: Chatter, names: ros2, each: queue}}
  - {{publish: Words, topic: words, type: std_msgs::msg::String, names: ros2}}
"""
TOPICS = ["write:rt/chatter:string:reliable:volatile", "read:rt/words:string:reliable:volatile"]
# Often enough to last (LastingProblems). Those of Fast DDS come every 3 s.
CYCLONE = "<CycloneDDS><Domain><Discovery><SPDPInterval>1s</SPDPInterval></Discovery></Domain></CycloneDDS>"


class Case:
    def __init__(self, programs, transports, plain, domain, secured):
        self.node, self.rabit = programs
        self.transports, self.plain, self.domain, self.secured = transports, plain, domain, secured
        self.names = NODES if secured else NODES[:1]
        self.failure = None

    def __str__(self):
        return f"{pathlib.Path(self.plain).name} beside {'nodes with' if self.secured else 'a node without'} keys"

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                self.fly(pathlib.Path(folder), processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def configure(self, folder):
        """Returns the file of each node."""
        if self.secured:
            field.run(self.rabit, "keys", "init", fleet_keys.of(folder))
        files = []
        for name, transport in zip(self.names, self.transports):
            files.append(folder / f"{name}.yaml")
            files[-1].write_text(CONFIG.format(node=name, domain=self.domain, transport=transport), encoding="utf-8")
            if self.secured:
                fleet_keys.add(self.rabit, folder, name)
                with open(files[-1], "a", encoding="utf-8") as file:
                    file.write(f"security: {{keys: {fleet_keys.of(folder, name)}}}\n")
        return files

    def fly(self, folder, processes):
        plain = processes.start([self.plain, self.domain, *TOPICS], {"CYCLONEDDS_URI": CYCLONE})
        plain.wait_for("ready".__eq__, LIMIT_S)
        nodes = [processes.start([self.node, file]) for file in self.configure(folder)]
        heard = re.compile(r"queue Chatter \d+").fullmatch
        got = re.compile(r"got rt/words \d+").fullmatch
        if not self.secured:
            plain.wait_for(got, LIMIT_S)
            for node in nodes:
                node.wait_for(heard, LIMIT_S)
            return
        # It takes ten seconds and more, in which the program has announced itself ten times.
        for node in nodes:
            node.wait_for(lambda text: "a program without keys sends there" in text, LIMIT_S)
        for node in nodes:
            assert not any(heard(text) for _, text in node.lines), "a node heard the program"
        assert not any(got(text) for _, text in plain.lines), "the program heard a node"


def main():
    programs, transports, plain = sys.argv[1:3], sys.argv[3].split(","), sys.argv[4:]
    harness.enter_namespace_or_skip()
    cases = [Case(programs, (transports * 2)[:2], program, harness.domain() + 5 * number, secured)
             for number, (program, secured) in enumerate((program, secured) for program in plain for secured in (False, True))]
    harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: {case.failure or 'as it should be'}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
