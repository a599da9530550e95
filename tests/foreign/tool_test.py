#!/usr/bin/env python3
"""The program `rabit` shows, measures and records topics of plain programs of each vendor, with the names, types and QoS of
ROS 2. It takes the types from .msg files.

Usage: tool_test.py RABIT TRANSPORT,... PLAIN_PROGRAM..."""

import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402
from foreign_test import CYCLONE, LIMIT_S  # noqa: E402

TOPICS = ["write:rt/chatter:string:reliable:volatile", "write:rt/latched:string:reliable:transient_local"]
TYPE = ["--type", "std_msgs/msg/String", "--idl", str(HERE.parent / "idl/ros/packages")]


class Case:
    """One backend beside a program of one vendor, in a domain of their own."""

    def __init__(self, rabit, transport, plain, domain):
        self.rabit, self.transport, self.plain, self.domain = rabit, transport, plain, domain
        self.failure = None

    def __str__(self):
        return f"{self.transport} beside {pathlib.Path(self.plain).name}"

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                plain = processes.start([self.plain, self.domain, *TOPICS], {"CYCLONEDDS_URI": CYCLONE})
                plain.wait_for("ready".__eq__, LIMIT_S)
                self.show()
                self.record(folder)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def call(self, command, *arguments):
        return subprocess.run([self.rabit, command, "--interface", "127.0.0.1", "--domain", str(self.domain), "--transport",
                               self.transport, *arguments], capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def show(self):
        for name, topic in ("/chatter", "rt/chatter"), ("rt/latched", "rt/latched"):
            done = self.call("echo", name, *TYPE, "--once", "--json", "--wait", "60")
            assert done.returncode == 0, done.stderr
            row = json.loads(done.stdout)
            assert (row["node"], row["message"], row["type"]) == (None, topic, "std_msgs::msg::String"), row
            assert row["value"]["data"].isdigit(), row
        done = self.call("hz", "/chatter", *TYPE, "--for", "8", "--json")
        assert done.returncode == 0 and json.loads(done.stdout)["values"] > 1, done
        done = self.call("echo", "/chattr", *TYPE, "--once", "--wait", "8")
        assert done.returncode == 1, done
        assert "no program writes `rt/chattr`" in done.stderr and "did you mean `rt/chatter`" in done.stderr, done.stderr
        done = self.call("echo", "/chatter", "--once")
        assert done.returncode == 2 and "expected its type" in done.stderr, done.stderr

    def record(self, folder):
        done = self.call("record", "/chatter", *TYPE, "--to", folder, "--for", "3", "--wait", "60", "--json")
        assert done.returncode == 0, done.stderr
        recorded = json.loads(done.stdout.splitlines()[-1])
        told = subprocess.run([self.rabit, "info", f"{folder}/{recorded['last_file']}", "--json"], capture_output=True, text=True,
                              timeout=LIMIT_S, check=True)
        topics = json.loads(told.stdout)["topics"]
        (topic,) = [one for one in topics if one["topic"].endswith("/rt/chatter")]
        assert topic["type"] == "std_msgs::msg::String" and topic["messages"] > 1, topic


def main():
    rabit, transports, plain = sys.argv[1], sys.argv[2].split(","), sys.argv[3:]
    harness.enter_namespace()
    pairs = [(transport, program) for transport in transports for program in plain]
    cases = [Case(rabit, transport, program, (harness.domain() + 5 * number) % 200)
             for number, (transport, program) in enumerate(pairs)]
    harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: {case.failure or 'as it should be'}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
