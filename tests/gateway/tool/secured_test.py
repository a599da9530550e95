#!/usr/bin/env python3
"""The program `rabit` from the shell, against a fleet with keys: two aircraft, one on each DDS implementation.

Usage: secured_test.py RABIT UAV TRANSPORT[,TRANSPORT]..."""

import itertools
import json
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "shell"))
import harness  # noqa: E402
from two_aircraft import aircraft_config, is_well  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 300


class Fleet:
    """Makes keys, and runs the program as one who types it. `transport` is the tool's."""

    def __init__(self, program, transport, domain, folder):
        self.program, self.transport, self.domain, self.folder = program, transport, domain, folder
        self._tools = itertools.count()

    def keys(self, *words):
        done = subprocess.run([self.program, "keys", *map(str, words)], capture_output=True, text=True, timeout=LIMIT,
                              check=False)
        assert done.returncode == 0, (words, done)

    def make(self, name):
        self.keys("init", self.folder / name)

    def add(self, fleet, node, *words):
        self.keys("add", node, "--keys", self.folder / fleet, *words)
        return str(self.folder / fleet / node)

    def tool(self, fleet):
        return self.add(fleet, f"laptop{next(self._tools)}-{self.transport}", "--tool")

    def run_anywhere(self, command, *arguments):
        return subprocess.run([self.program, command, *map(str, arguments), "--interface", "127.0.0.1"],
                              capture_output=True, text=True, timeout=LIMIT, check=False)

    def run(self, command, *arguments):
        return self.run_anywhere(command, *arguments, "--domain", self.domain, "--transport", self.transport)


def a_tool_with_keys_sees_and_sends(fleet):
    keys = fleet.tool("fleet")

    def both():
        done = fleet.run("nodes", "--keys", keys, "--json", "--wait", "60")
        rows = {row["node"]: row["state"] for row in map(json.loads, done.stdout.splitlines()) if "state" in row}
        return is_well(done) and rows == {"uav1": "UP", "uav2": "UP"}
    harness.until(both)
    for node in ("uav1", "uav2"):
        # Nodes may meet later than --wait ends, so the command is repeated, as a person would.
        def echoed(node=node):
            done = fleet.run("echo", f"{node}/Pose", "--keys", keys, "--once", "--json", "--wait", "60")
            return done.returncode == 0 and "latitude_deg" in json.loads(done.stdout)["value"]
        harness.until(echoed)

        def delivered(node=node):
            done = fleet.run("send", f"{node}/MissionControl", "Uav::GoHome", '{"reason": "test"}', "--keys", keys,
                             "--wait", "60")
            return done.returncode == 0 and done.stdout == "delivered\n"
        harness.until(delivered)

    def listed():
        done = fleet.run("messages", "--keys", keys, "--wait", "60")
        return done.returncode == 0 and "Pose" in done.stdout
    harness.until(listed)


def a_configuration_names_keys_as_well(fleet):
    keys = fleet.tool("fleet")
    config = fleet.folder / f"{fleet.transport}.yaml"
    config.write_text(f"domain: {fleet.domain}\ntransport: {fleet.transport}\nsecurity: {{keys: {keys}}}\n")

    def echoed():
        done = fleet.run_anywhere("echo", "uav1/Pose", "--config", config, "--once", "--wait", "60")
        return done.returncode == 0 and "latitude_deg" in done.stdout
    harness.until(echoed)


def a_doctor_with_keys_finds_the_fleet_and_one_without_says_that_it_has_some(fleet):
    keys = fleet.tool("fleet")

    def well():
        done = fleet.run("doctor", "--keys", keys, "--wait", "4")
        return is_well(done) and "nodes: uav1 uav2" in done.stdout
    harness.until(well)

    def told():
        done = fleet.run("doctor", "--json")
        found = {row["subject"]: row for row in map(json.loads, done.stdout.splitlines())}
        assert done.returncode == 3, done
        return "keys" in found and found["keys"]["level"] == "problem" and found["keys"]["text"].startswith(
            f"nodes at 127.0.0.1 in domain {fleet.domain} have keys, and this program has none")
    harness.until(told)


def a_tool_without_keys_says_that_the_fleet_has_some(fleet):
    for command in (["nodes"], ["echo", "uav1/Pose"], ["send", "uav1/MissionControl", "Uav::GoHome", "{}"]):
        def told(command=command):
            done = fleet.run(*command, "--wait", "2")
            assert done.returncode == 3 and done.stdout == "" and "nobody was heard" in done.stderr, done
            return "have keys, and this program has none" in done.stderr and "--keys FOLDER" in done.stderr
        harness.until(told)


def a_tool_with_keys_of_another_fleet_says_that_the_keys_fit_nobody(fleet):
    keys = fleet.tool("other")

    def told():
        done = fleet.run("nodes", "--keys", keys, "--wait", "4")
        assert done.returncode == 3, done
        return "none is heard with the keys of this program" in done.stderr
    harness.until(told)


def what_is_wrong_with_keys_is_one_line(fleet):
    node = str(fleet.folder / "fleet" / "uav1")
    for keys, expected in ((fleet.folder / "nowhere", "there is no folder of keys"),
                           (fleet.folder / "fleet", "is the folder of a fleet; name the folder of one node in it"),
                           (fleet.folder / "fleet" / "authority", "authority/"),
                           (node, "a tool needs keys of its own: `rabit keys add <name> --tool`")):
        done = fleet.run("nodes", "--keys", keys, "--wait", "2")
        assert done.returncode in (1, 2, 3) and expected in done.stderr, done
        assert len(done.stderr.splitlines()) == 1 and done.stdout == "", done


TESTS = [a_tool_with_keys_sees_and_sends, a_configuration_names_keys_as_well,
         a_doctor_with_keys_finds_the_fleet_and_one_without_says_that_it_has_some,
         a_tool_without_keys_says_that_the_fleet_has_some, a_tool_with_keys_of_another_fleet_says_that_the_keys_fit_nobody,
         what_is_wrong_with_keys_is_one_line]


def main():
    program, uav, transports = sys.argv[1], sys.argv[2], sys.argv[3].split(",")
    harness.enter_namespace()
    domain = harness.domain()
    with tempfile.TemporaryDirectory() as name, harness.Processes() as processes:
        folder = pathlib.Path(name)
        maker = Fleet(program, transports[0], domain, folder)
        maker.make("fleet")
        maker.make("other")
        config = aircraft_config(folder)
        for k in (1, 2):
            transport = transports[(k - 1) % len(transports)]
            keys = maker.add("fleet", f"uav{k}", "--config", config)
            processes.start([uav, "--config", config, "--node", f"uav{k}", "--domain", domain, "--transport", transport,
                             "--keys", keys])
        for transport in transports:
            fleet = Fleet(program, transport, domain, folder)
            for test in TESTS:
                begin = time.monotonic()
                test(fleet)
                print(f"ok: {test.__name__} over {transport}, {time.monotonic() - begin:.1f} s", flush=True)


if __name__ == "__main__":
    main()
