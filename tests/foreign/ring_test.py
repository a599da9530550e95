#!/usr/bin/env python3
"""Three nodes in a ring that each read a program's topic, mirror it on to the next, and write what they get of the one
before to the same topic: nothing goes round. Without a rule that says so nothing of it is mirrored at all.

Usage: ring_test.py NODE TRANSPORT,... PLAIN_PROGRAM..."""

import pathlib
import re
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402
from foreign_test import CYCLONE, LIMIT_S  # noqa: E402

NODES = ["a", "b", "c"]
CONFIG = """
node: {node}
domain: {domain}
transport: {transport}
interfaces: [127.0.0.1]
publish:
  - {{message: Chatter, type: std_msgs::msg::String, qos: telemetry}}
subscribe:
  - {{message: Chatter, type: std_msgs::msg::String, from: [{before}]}}
  - {{message: Silent, type: std_msgs::msg::String, from: [{before}]}}
foreign:
  - {{subscribe: rt/chatter, type: std_msgs::msg::String, as: Chatter, names: ros2}}
  - {{subscribe: rt/silent, type: std_msgs::msg::String, as: Silent, names: ros2}}
  - {{publish: {before}/Chatter, topic: rt/chatter, type: std_msgs::msg::String, names: ros2}}
  - {{publish: {before}/Silent, topic: rt/echo, type: std_msgs::msg::String, names: ros2}}
"""


def numbers(process, topic):
    return [int(text.split()[2]) for _, text in process.lines if text.startswith(f"got {topic} ")]


def main():
    node, transports, plain = sys.argv[1], sys.argv[2].split(","), sys.argv[3]
    harness.enter_namespace()
    domain = harness.domain()
    environment = {"CYCLONEDDS_URI": CYCLONE}
    with tempfile.TemporaryDirectory(prefix="rabit_ring_") as folder, harness.Processes() as processes:
        listener = processes.start([plain, domain, "read:rt/chatter:string:reliable:volatile",
                                    "read:rt/echo:string:reliable:volatile"], environment)
        nodes = []
        for i, name in enumerate(NODES):
            config = pathlib.Path(folder) / f"{name}.yaml"
            config.write_text(CONFIG.format(node=name, domain=domain, transport=transports[i % len(transports)],
                                            before=NODES[i - 1]))
            nodes.append(processes.start([node, config]))
        writer = processes.start([plain, domain, "write:rt/chatter:string:reliable:volatile",
                                  "write:rt/silent:string:reliable:volatile"], environment)
        for process in nodes:
            process.wait_for(re.compile(r"message Silent \d+ .*").fullmatch, LIMIT_S)
            # Each sample that a node reads goes on to the next node, and comes out there.
        listener.wait_for(lambda _: len(numbers(listener, "rt/chatter")) > 60, LIMIT_S)
        listener.wait_for(lambda _: any(numbers(listener, "rt/chatter").count(n) == 4
                                        for n in set(numbers(listener, "rt/chatter"))), LIMIT_S)
        assert writer.terminate() == 0
        last = len(numbers(listener, "rt/chatter"))
        # The samples end with the writer: a sample that went round would go on.
        quiet = 0
        end = time.monotonic() + LIMIT_S
        while quiet < 20 and time.monotonic() < end:
            time.sleep(0.1)
            now = len(numbers(listener, "rt/chatter"))
            quiet = quiet + 1 if now == last else 0
            last = now
        assert quiet == 20, "samples still come"
        heard = numbers(listener, "rt/chatter")
        most = max(heard.count(n) for n in set(heard))
        assert most <= 1 + len(NODES), f"a number came {most} times"
        assert not numbers(listener, "rt/echo"), "it was mirrored without a rule"
        for process in nodes:
            assert process.terminate() == 0, process.lines[-5:]
        print(f"{len(heard)} samples, none more than {most} times")


if __name__ == "__main__":
    main()
