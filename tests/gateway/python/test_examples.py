"""The examples run, and their types are right. RABIT_BIN: the folder of the programs uav and vision."""

import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

import rabit
from conftest import ROOT, wait_until

EXAMPLES = ROOT / "gateway/python/examples"
IDL = str(ROOT / "idl/messages/uav.idl")
BIN = pathlib.Path(os.environ.get("RABIT_BIN", "/nowhere"))
HONEST = {"REFUSED", "EXPIRED"}  # outcomes until the queue is known, and of what came later than first.py allows


def start(name, *arguments):
    return subprocess.Popen([sys.executable, str(EXAMPLES / name), *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)


def without_warnings(lines):
    """Of a node that nobody was heard, say, or that it ended before a message was acknowledged."""
    return (line for line in lines if not line.startswith("rabit: warning: "))


def outcomes_of(planner, node):
    """Those that the first program says, up to the first DELIVERED."""
    said = []
    for line in without_warnings(iter(planner.stdout.readline, "")):
        said.append(line.replace(f"{node} Outcome.", "").strip())
        if said[-1] == "DELIVERED":
            break
    return said


def test_the_first_program_commands_an_aircraft(idl, one_network):
    assert len((EXAMPLES / "first.py").read_text().splitlines()) <= 30
    settings = {**one_network, "transport": "fastdds"}
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, accept={"MissionControl": [idl.Uav.Goto]}, **settings)
    with uav, start("first.py", IDL, one_network["domain"]) as planner:
        try:
            commands = uav.queue("MissionControl")
            def ordered():
                uav.post("Pose", idl.Uav.Pose(altitude_m=80))
                return len(commands)
            wait_until(ordered, 240)
            assert commands.get().value.altitude_m == 120
            *before, first = outcomes_of(planner, "uav1")
            assert first == "DELIVERED" and set(before) <= HONEST, before
        finally:
            planner.kill()


def test_an_aircraft_in_python_obeys_the_first_program(one_network, tmp_path):
    with start("aircraft.py", IDL, one_network["domain"], "uav7", tmp_path) as aircraft, \
            start("first.py", IDL, one_network["domain"]) as planner:
        try:
            *before, first = outcomes_of(planner, "uav7")
            assert first == "DELIVERED" and set(before) <= HONEST, before
            assert aircraft.stdout.readline().startswith("Uav.Goto(")
            planner.send_signal(signal.SIGINT)
            said, _ = planner.communicate(timeout=60)
            allowed = {"uav7 Outcome.DELIVERED", "uav7 Outcome.EXPIRED"}
            assert planner.returncode == 0 and set(without_warnings(said.splitlines())) <= allowed, said
        finally:
            planner.kill()
            aircraft.send_signal(signal.SIGINT)
            aircraft.wait(120)
    assert next(iter(rabit.open(tmp_path).messages("uav7/Pose"))).value.altitude_m >= 80


def test_the_ground_station_draws_what_it_sees(idl, one_network, tmp_path):
    pytest.importorskip("matplotlib")
    uav = rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, **one_network)
    with uav, start("ground_station.py", "--idl", IDL, "--domain", one_network["domain"], "--interface", "127.0.0.1",
                    "--transport", one_network["transport"], "--seconds", 20, "--picture",
                    tmp_path / "plot.png") as viewer:
        while viewer.poll() is None:
            uav.post("Pose", idl.Uav.Pose(altitude_m=80))
            time.sleep(0.1)
        assert viewer.stdout.read().endswith("saw uav1\n")
    assert (tmp_path / "plot.png").stat().st_size > 1000


@pytest.mark.skipif(not (BIN / "uav").exists(), reason="the swarm example is not built")
def test_the_mission_flies_the_swarm_example_and_its_recordings_are_analysed(one_network, tmp_path):
    common = ["--domain", str(one_network["domain"]), "--transport", "fastdds"]
    swarm = ROOT / "examples/swarm"
    recorded = tmp_path / "uav.yaml"
    recorded.write_text((swarm / "uav.yaml").read_text() + f"record: {{folder: {tmp_path}}}\n")
    programs = []
    try:
        for name in ("uav1", "uav2"):
            for program, config, node in (("uav", recorded, name), ("vision", swarm / "vision.yaml", name + ".vision")):
                programs.append(subprocess.Popen(
                    [BIN / program, "--config", config, "--world", swarm / "world.yaml", "--node", node, *common],
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        with start("mission.py", "--idl", IDL, *common, "--interface", "127.0.0.1", "--aircraft", 2, "--seconds", 240) as mission:
            try:
                said, _ = mission.communicate(timeout=400)
            finally:
                mission.kill()
        assert mission.returncode == 0, said
        for line in ("Search to uav1: DELIVERED", "Search to uav2: DELIVERED", "COMMAND_ACCEPTED",
                     "GoHome to uav1: DELIVERED"):
            assert line in said
    finally:
        for program in programs:
            program.terminate()
        for program in programs:
            program.wait(120)
    pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    with start("analysis.py", *sorted(tmp_path.glob("*.mcap")), "--figures", tmp_path) as analysis:
        said, _ = analysis.communicate(timeout=400)
    assert analysis.returncode == 0 and "uav1:" in said and "uav2:" in said, said
    assert (tmp_path / "tracks.png").stat().st_size > 1000 and (tmp_path / "ages.png").stat().st_size > 1000


def test_the_types_are_right():
    pytest.importorskip("mypy")
    config = ROOT / "gateway/python/pyproject.toml"
    found = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--config-file", config, "--cache-dir", "/dev/null",
                            "rabit", *sorted(EXAMPLES.glob("*.py"))],
                           cwd=ROOT / "gateway/python", capture_output=True, text=True)
    assert found.returncode == 0, found.stdout


def test_the_package_is_the_program_rabit(tmp_path):
    program = tmp_path / "rabit"
    program.write_text("#!/bin/sh\necho program $@\n")
    program.chmod(0o755)
    shown = subprocess.run([sys.executable, "-m", "rabit", "nodes"], capture_output=True, text=True,
                           env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"})
    assert shown.stdout == "program nodes\n" or "nobody" in shown.stdout + shown.stderr


def test_the_package_is_installed_by_pip(tmp_path):
    """From a build that is there: RABIT_BUILD."""
    pytest.importorskip("pip")
    if not os.environ.get("RABIT_BUILD"):
        pytest.skip("RABIT_BUILD is not set")
    installed = subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--target",
                                tmp_path / "site", ROOT / "gateway/python"], capture_output=True, text=True)
    assert installed.returncode == 0, installed.stderr
    shown = subprocess.run([sys.executable, "-c", "import rabit; print(rabit.__version__, rabit.__file__)"],
                           env={**os.environ, "PYTHONPATH": str(tmp_path / "site")}, capture_output=True, text=True)
    assert shown.stdout.split() == [rabit.__version__, str(tmp_path / "site/rabit/__init__.py")], shown.stderr
