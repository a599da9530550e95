"""Flights in the lab from pytest: the fixture of the plugin `rabit.lab`. RABIT_BIN: the folder of the program uav."""

import os
import pathlib
import subprocess
import sys
import textwrap

import pytest

from conftest import ROOT

UAV = pathlib.Path(os.environ.get("RABIT_BIN", "/nowhere")) / "uav"

PLANNER = """
import signal, time, rabit
idl = rabit.load_idl({idl!r})
with rabit.Node("planner", domain=7, publish={{"Plan": idl.Uav.Pose}}) as node:
    signal.signal(signal.SIGTERM, lambda *_: node.stop())
    while node.is_running:
        node.post("Plan", idl.Uav.Pose())
        time.sleep(0.1)
"""


def results(folder, test, *options):
    """Runs pytest with a test that uses the plugin, in a folder. Returns its exit code and its output."""
    (folder / "conftest.py").write_text('pytest_plugins = ["rabit.lab"]\n')
    (folder / "test_flight.py").write_text(textwrap.dedent(test))
    done = subprocess.run([sys.executable, "-m", "pytest", "-rs", "-q", "-p", "no:cacheprovider", *options, folder],
                          capture_output=True, text=True, timeout=800)
    if "skipped" in done.stdout:
        pytest.skip(done.stdout)
    return done.returncode, done.stdout


@pytest.mark.skipif(not UAV.exists(), reason="the swarm example is not built")
def test_a_scenario_is_flown_and_its_recording_is_read(tmp_path):
    (tmp_path / "planner.py").write_text(PLANNER.format(idl=str(ROOT / "idl/messages/uav.idl")))
    code, said = results(tmp_path, f"""
        import sys

        def test_flight(lab):
            uav = {{"command": [{str(UAV)!r}, "--config", "{ROOT}/examples/swarm/uav.yaml", "--node", "{{node}}"]}}
            planner = {{"command": [sys.executable, "{tmp_path}/planner.py"]}}
            flight = lab.fly({{
                "nodes": {{"uav1": uav, "planner": planner}},
                "run": "25s",
                "expect": ["all up within 24s", {{"exit codes": 0}}],
            }})
            assert flight.passed and flight.verdict("all up").met
            assert "planner" in flight.log and flight.report.exists()
            assert {{"uav1/Pose", "planner/Plan"}} <= {{topic.name for topic in flight.recording().topics}}
            assert flight.recording().to_pandas("planner/Gateway/Fleet").size > 0
        """, "--lab-results", tmp_path / "results")
    assert code == 0, said
    assert list(tmp_path.glob("results/*test_flight/flight1/junit.xml"))


def test_an_expectation_that_is_not_met_fails_the_test(tmp_path):
    (tmp_path / "flight.yaml").write_text("nodes: {one: {command: [sleep, 1], plain: true}}\nrun: 10s\nexpect: []\n")
    code, said = results(tmp_path, """
        def test_flight(lab):
            assert not lab.fly("flight.yaml", check=False).passed
            lab.fly("flight.yaml")
        """)
    assert code == 1 and "\nnot met: no node ends by itself: one ended by itself" in said, said


def test_a_second_run_replaces_the_results_of_the_first(tmp_path):
    (tmp_path / "flight.yaml").write_text("nodes: {one: {command: [sleep, 20], plain: true}}\nrun: 1s\nexpect: []\n")
    flight = """
        def test_flight(lab):
            lab.fly("flight.yaml", check=False)
        """
    for _ in range(2):
        code, said = results(tmp_path, flight, "--lab-results", tmp_path / "results")
        assert code == 0, said
        (folder,) = tmp_path.glob("results/*/*/")
        assert folder.name == "flight1" and not (folder / "mark").exists()
        (folder / "mark").touch()


def test_a_wrong_scenario_is_an_error_with_its_line(tmp_path):
    (tmp_path / "flight.yaml").write_text("nodes: {one: {command: [sleep, 2], plain: true}}\nruns: 3s\n")
    code, said = results(tmp_path, """
        import pytest, rabit

        def test_flight(lab):
            with pytest.raises(rabit.ConfigError, match="flight.yaml:2: .*runs"):
                lab.fly("flight.yaml")
        """)
    assert code == 0, said
