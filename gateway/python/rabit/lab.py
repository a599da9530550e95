"""Flights in the lab (`rabit lab`) as tests: a plugin of pytest with the fixture `lab`.

    pytest_plugins = ["rabit.lab"]  # in conftest.py

    def test_the_fleet_survives_a_crash(lab):
        flight = lab.fly("crash.yaml")
        assert flight.recording().to_pandas("ground/Gateway/Fleet").size > 0

A test is skipped where the machine allows no namespaces.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
from collections.abc import Mapping
from typing import Any

import pytest

from . import _tool
from ._rabit import ConfigError
from .recordings import Recording, open

# Exit codes of `rabit lab run`.
_FAILED, _USAGE, _IMPOSSIBLE = 1, 2, 3


@dataclasses.dataclass(frozen=True)
class Verdict:
    """An expectation of the scenario, and the observation that decided it."""

    expected: str
    seen: str
    met: bool

    def __str__(self) -> str:
        return ("met: " if self.met else "not met: ") + self.expected + (f": {self.seen}" if self.seen else "")


@dataclasses.dataclass(frozen=True)
class Flight:
    """The result of a scenario."""

    folder: pathlib.Path  # gateway/lab/README.md lists its files
    verdicts: list[Verdict]

    @property
    def passed(self) -> bool:
        return all(verdict.met for verdict in self.verdicts)

    @property
    def report(self) -> pathlib.Path:
        return self.folder / "report.html"

    @property
    def log(self) -> str:
        """Output, logs, states and problems of all nodes, in one order."""
        return (self.folder / "log.txt").read_text(encoding="utf-8", errors="replace")

    def recording(self) -> Recording:
        """Returns the posts and receipts of all nodes, on one time line."""
        return open(self.folder / "flight.mcap")

    def verdict(self, expected: str) -> Verdict:
        """Returns the verdict on the expectation that begins with this text."""
        for verdict in self.verdicts:
            if verdict.expected.startswith(expected):
                return verdict
        raise KeyError(f"no expectation begins with `{expected}`: {', '.join(one.expected for one in self.verdicts)}")


class Lab:
    """Flies scenarios, each into a folder of its own."""

    def __init__(self, folder: pathlib.Path, beside: pathlib.Path) -> None:
        self._folder = folder
        self._beside = beside
        self._flights = 0

    def fly(self, scenario: str | os.PathLike[str] | Mapping[str, Any], *, check: bool = True) -> Flight:
        """Runs a scenario to its end, in real time. `scenario` is a file (from the folder of the test), or a dict with
        what such a file has; its programs are found in PATH or have absolute paths.

        Fails the test if an expectation was not met; with `check=False` it does not, and `passed` tells. A wrong
        scenario is a ConfigError."""
        self._flights += 1
        folder = self._folder / f"flight{self._flights}"
        if isinstance(scenario, Mapping):
            self._folder.mkdir(parents=True, exist_ok=True)
            file = self._folder / f"scenario{self._flights}.yaml"
            file.write_text(json.dumps(scenario, indent=1, default=os.fspath), encoding="utf-8")  # YAML has JSON in it
        else:
            file = self._beside / scenario
        program = _tool.program()
        if program is None:
            pytest.fail(_tool.MISSING, pytrace=False)
        done = subprocess.run([program, "lab", "run", file, "--to", folder], stderr=subprocess.PIPE, text=True)
        said = done.stderr.strip().removeprefix("rabit: ")
        if done.returncode == _USAGE:
            raise ConfigError(said)
        if done.returncode == _IMPOSSIBLE:
            pytest.skip(said)
        if done.returncode not in (0, _FAILED):
            pytest.fail(f"rabit lab ended with {done.returncode}: {said}", pytrace=False)
        flight = Flight(folder, [_verdict_of(line) for line in _lines_of(folder / "verdicts.txt")])
        if check and not flight.passed:
            missed = [str(verdict) for verdict in flight.verdicts if not verdict.met]
            pytest.fail("\n".join([*missed, str(flight.report)]), pytrace=False)
        return flight


def _lines_of(file: pathlib.Path) -> list[str]:
    return file.read_text(encoding="utf-8").split("\n")[:-1]


def _verdict_of(line: str) -> Verdict:
    met, expected, seen = line.split("\t", 2)
    return Verdict(expected, seen, met == "met")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.getgroup("rabit").addoption(
        "--lab-results", metavar="FOLDER", help="the results of flights in the lab stay there, in a folder for each test"
        " that its next run replaces"
    )


@pytest.fixture
def lab(request: pytest.FixtureRequest, tmp_path: pathlib.Path) -> Lab:
    """Flies scenarios of `rabit lab`."""
    folder = tmp_path
    if wanted := request.config.getoption("--lab-results"):
        folder = pathlib.Path(wanted).resolve() / re.sub(r"[^\w.-]+", "_", request.node.nodeid)
        shutil.rmtree(folder, ignore_errors=True)  # the results of the run before
    return Lab(folder, request.path.parent)
