"""The pieces of code on the page of the manual run, in the order of the page."""

import os
import pathlib
import re
import shutil
import subprocess

import pytest

import rabit
from conftest import ROOT, wait_until

PAGE = (ROOT / "docs/how_to/python.md").read_text()
TOOL = pathlib.Path(os.environ.get("RABIT_BIN", "/nowhere")) / "rabit"


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture
def flight(idl, one_network, tmp_path):
    """A recorded flight, and the files that the page speaks of."""
    folder = tmp_path / "flight"
    with rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, record={"folder": str(folder)}, **one_network) as node:

        def is_recorded():
            node.post("Pose", idl.Uav.Pose(altitude_m=80))
            try:
                return any(topic.name == "uav1/Pose" for file in folder.glob("*.mcap") for topic in rabit.open(file).topics)
            except RuntimeError:  # the file has no beginning yet
                return False

        wait_until(is_recorded)
    shutil.copy(ROOT / "idl/messages/uav.idl", tmp_path)
    (tmp_path / "string.idl").write_text(blocks("idl")[0])
    (tmp_path / "planner.yaml").write_text("node: planner\ndomain: 7\n")
    subprocess.run([TOOL, "keys", "init"], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([TOOL, "keys", "add", "planner", "--config", "planner.yaml"], cwd=tmp_path, check=True,
                   stdout=subprocess.DEVNULL)
    return tmp_path


@pytest.mark.skipif(not TOOL.exists(), reason="the program rabit is not built")
def test_the_code_of_the_manual_runs(flight, monkeypatch, capsys):
    pytest.importorskip("pandas")
    monkeypatch.chdir(flight)
    code = blocks("python")
    assert len(code) == 3
    for block in code:
        exec(block.replace("/tmp/flight", str(flight / "flight")), {})
    shown = capsys.readouterr().out
    assert "uav1/Pose" in shown and "max" in shown
