#!/usr/bin/env python3
"""Real containers: the example fleet under the fault console, then scenarios with ledgers and the judge.

Usage: docker_test.py CMAKE BUILD_FOLDER TRANSPORT,... SCENARIO..."""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import docker_engine
import docker_field
import field
import run_scenario

HERE = pathlib.Path(__file__).resolve().parent
UAVS = 3
LIMIT_S = 60  # only keeps a broken test from hanging


class Console:
    """fleet.sh for one fleet, and what its ground station has shown."""

    def __init__(self, engine, transports):
        self._engine = engine
        engine.environment.update(FLEET=engine.mark, IMAGE=engine.image, RUN_OPTIONS="",
                                  TRANSPORTS=" ".join(transports))

    def __call__(self, *arguments):
        return self._engine.run(docker_field.CONSOLE, *arguments)

    def wait_for_row(self, node, pattern):
        """Until the newest row of that node at the ground station looks like this."""
        wanted = re.compile(pattern)
        end = time.monotonic() + LIMIT_S
        rows = []
        while time.monotonic() < end:
            rows = [line for line in self("logs", "ground", "--tail", "20").splitlines()
                    if re.match(rf"\s*\S+ s\s+{node} ", line)]
            if rows and wanted.search(rows[-1]):
                return
            time.sleep(0.5)
        raise AssertionError(f"no row of {node} with '{pattern}' within {LIMIT_S} s; the last one: {rows[-1:]}")


    def wait_for_line(self, pattern):
        """Until the ground station has shown such a line."""
        wanted = re.compile(pattern)
        end = time.monotonic() + 4 * LIMIT_S
        while time.monotonic() < end:
            if wanted.search(self("logs", "ground")):
                return
            time.sleep(2)
        raise AssertionError(f"no line '{pattern}' within {4 * LIMIT_S} s")


def fly_example(engine, transports):
    """The example's aircraft come up, on these backends in turn, and find a target; one is cut off and healed, all are on a radio that carries next to nothing for a while, one is killed and started
    again; all are removed."""
    fleet = Console(engine, transports)
    try:
        fleet("up", UAVS)
        for k in range(1, UAVS + 1):
            fleet.wait_for_row(f"uav{k}", r" UP .*[1-9] acknowledged")
        fleet.wait_for_line(r"target uav\d/\d+ +TRACKED .* validated by uav\d")
        fleet("cut", "uav2")
        fleet.wait_for_row("uav2", " LOST ")
        fleet.wait_for_row("uav1", " UP ")
        assert "in cut out cut" in fleet("status"), fleet("status")
        fleet("heal", "uav2")
        fleet.wait_for_row("uav2", " UP ")
        fleet("radio", 1)
        fleet.wait_for_row("uav2", " LOST ")
        assert "packets dropped" in fleet("status"), fleet("status")
        fleet("radio", "off")
        fleet.wait_for_row("uav2", " UP ")
        fleet("kill", "uav1")
        fleet.wait_for_row("uav1", " LOST ")
        fleet("start", "uav1")
        fleet.wait_for_row("uav1", " UP ")
        code = fleet("stop", "uav3").strip()
        assert code == "0", f"uav3 ended with {code}"
        fleet.wait_for_row("uav3", " LOST ")
        user = engine.run("docker", "exec", f"{engine.mark}-uav1", "id", "-u").strip()
        assert user != "0", "the nodes run as root"
    except BaseException:
        print(fleet("status"))
        raise
    finally:
        fleet("down")
    left = engine.run("docker", "ps", "--all", "--quiet", "--filter", f"label=rabit.fleet={engine.mark}")
    assert not left, f"left behind: {left}"


def keep_strangers_out(engine, transports):
    """The example's aircraft come up with keys of their own, and one comes back. A program without keys hears nobody. No
    node has the private keys of another one, or of the authority."""
    fleet = Console(engine, transports)
    try:
        fleet("up", "--secure", 2)
        for node in ("uav1", "uav2"):
            fleet.wait_for_row(node, r" UP .*[1-9] acknowledged")
        fleet.wait_for_line(r"Web page: https://\S+/\?token=[0-9a-f]{32}")
        for transport in transports:
            stranger = engine.run("docker", "run", "--rm", "--network", engine.mark, "--entrypoint", "rabit",
                                  engine.image, "nodes", "--domain", 7, "--transport", transport, "--wait", 4,
                                  check=False)
            assert "nobody was heard" in stranger, stranger
        for node in ("ground", "uav1", "uav2.vision"):
            keys = engine.run("docker", "exec", f"{engine.mark}-{node}", "find", "/var/lib/rabit", "/etc/rabit", "-name",
                              "key")
            folders = {str(pathlib.PurePath(line).parent) for line in keys.splitlines()}
            assert folders == {f"/var/lib/rabit/{node}"}, f"{node} has {folders}"
        fleet("kill", "uav1")
        fleet.wait_for_row("uav1", " LOST ")
        fleet("start", "uav1")
        fleet.wait_for_row("uav1", " UP ")
        fleet("run", "uav9", "uav")
        fleet.wait_for_row("uav9", " UP ")
    except BaseException:
        print(fleet("status"))
        raise
    finally:
        fleet("down")
    left = engine.run("docker", "volume", "ls", "--quiet", "--filter", f"label=rabit.fleet={engine.mark}")
    assert not left, f"left behind: {left}"


def build_image(engine, cmake, build):
    with tempfile.TemporaryDirectory(prefix=engine.mark + "-") as programs:
        subprocess.run([cmake, "--install", build, "--component", "programs", "--strip", "--prefix", programs],
                       check=True, stdout=subprocess.DEVNULL)
        engine.build(programs)


def main():
    cmake, build, transports, *scenarios = sys.argv[1:]
    failed = []
    with field.skipping():
        with docker_engine.Engine() as engine:
            build_image(engine, cmake, build)
            fly_example(engine, transports.split(","))
            print("ok: the example fleet")
            keep_strangers_out(engine, transports.split(","))
            print("ok: the example fleet with keys")
            for name in scenarios:
                scenario = json.loads((HERE / "scenarios" / name / "scenario.json").read_text())
                options = argparse.Namespace(ledger_node="ledger_node", transports=transports, keep=None)
                print(f"scenario {name}")
                with docker_field.DockerField(engine, scenario["nodes"]) as ground:
                    failed += [f"{name}: {text}" for text in run_scenario.run_in(ground, scenario, options)]
    for text in failed[:50]:
        print("WRONG " + text)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
