#!/usr/bin/env python3
"""Flights over three emulated radios are flown again over the same radio, in simulated time, and one of them in real time: p90 of
the ages of each message is about the same, and two replays in simulated time are exactly the same.

Usage: what_if_test.py RABIT UAV GROUND
Exit code 77: this machine allows no namespaces or devices for them, or was too busy in every try."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import lab_test
from lab_test import TRIES, check

# Of a network of the scenario, and the same for `rabit lab replay`.
RADIOS = {
    "lossy": ("{rate: 125kbit/s, loss: 5%, delay: 20ms}", ["--radio", "125kbit/s", "--loss", "5%", "--delay", "20ms"]),
    "bursts": ("{rate: 115.2kbit/s, loss: 10%, burst: 4, delay: 50ms, jitter: 20ms}",
               ["--radio", "115.2kbit/s", "--loss", "10%", "--burst", "4", "--delay", "50ms", "--jitter", "20ms"]),
    "thin": ("{rate: 57.6kbit/s}", ["--radio", "57.6kbit/s"]),
}
SCENARIO = """  ground: {command: [GROUND, --config, STATION]}
network:
  radio: RADIO
run: 60s
"""
AFTER = "15s"  # the nodes have met
IN_REAL_TIME = "lossy"
MESSAGES = ("Pose", "Health", "MissionState", "Findings")
AS_EMULATED = 0.2  # largest difference of the ages, as a share of the recorded one,
LATENESS_S = 0.05  # and in addition to it: the programs of the recorded flight ran on a machine that others use, too


def replay(case, rabit, options, folder):
    """The exit code of a replay and what it said."""
    done = subprocess.run([rabit, "lab", "replay", case.results / "flight.mcap", *options, "--after", AFTER, "--to", folder], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=lab_test.LIMIT_S, check=False)
    return done.returncode, done.stdout


def differences(case, folder, how):
    """The messages whose ages differ in a replay, or that did not arrive."""
    found = {row["message"]: row for row in json.loads((folder / "what_if.json").read_text(encoding="utf-8"))["messages"]}
    wrong = []
    for message in MESSAGES:
        flown, again = (found.get(message, {}).get(key) for key in ("recorded_p90", "p90"))
        if flown is None or again is None:
            wrong.append(f"{message} in {how} time did not arrive: p90 {flown} and {again}")
            continue
        print(f"{case.folder.name} {message}: age p90 {flown:.3f} s over the emulated radio, {again:.3f} s in {how} time")
        if abs(again - flown) > AS_EMULATED * flown + LATENESS_S:
            wrong.append(f"the age of {message} differs in {how} time: p90 {flown:.3f} s and {again:.3f} s")
    return wrong


def fly(case, rabit, options):
    """Records a flight and replays it. Returns what is wrong that a disturbed machine may explain."""
    case.run()
    if case.code == lab_test.IMPOSSIBLE:
        lab_test.skip(case.said)
    if case.code != 0:
        return [f"the flight ended with {case.code}: {case.said}"]
    folders = [case.results / "replayed", case.results / "again"]
    for folder in folders:
        code, said = replay(case, rabit, options, folder)
        check(code == 0, case, f"the replay ended with {code}: {said}")
    for name in ("report.html", "what_if.json"):
        check(folders[0].joinpath(name).read_bytes() == folders[1].joinpath(name).read_bytes(), case, f"two {name} of one seed differ")
    wrong = differences(case, folders[0], "simulated")
    if case.folder.name == IN_REAL_TIME:
        folder = case.results / "real"
        code, said = replay(case, rabit, [*options, "--real-time"], folder)
        if code != 0:
            return [*wrong, f"the replay in real time ended with {code}: {said}"]
        check((folder / "flight.mcap").exists(), case, "no recording of the flight in real time")
        wrong += differences(case, folder, "real")
    return wrong


def judge(case, rabit, options):
    """Flies until nothing is wrong, at most `TRIES` times. Fails if a try is wrong on an undisturbed machine. Returns false if the
    machine was disturbed in every try."""
    for number in range(1, TRIES + 1):
        shutil.rmtree(case.results, ignore_errors=True)
        wrong = fly(case, rabit, options)
        if not wrong:
            return True
        check(case.is_disturbed(), case, "; ".join(wrong))
        print(f"{case.folder.name}: the machine was disturbed in try {number} of {TRIES}: {'; '.join(wrong)}", flush=True)
    return False


def main():
    rabit, uav, ground = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
    station = str(lab_test.ROOT / "examples" / "ground_station" / "ground.yaml")
    with tempfile.TemporaryDirectory(prefix="rbtwhat-") as name:
        unjudged = []
        for radio, (network, options) in RADIOS.items():  # one fleet at a time: fleets on one machine would delay each other
            text = SCENARIO.replace("GROUND", ground).replace("STATION", station).replace("RADIO", network)
            if not judge(lab_test.Case(pathlib.Path(name), radio, text, 3, rabit, uav), rabit, options):
                unjudged.append(radio)
        if unjudged:
            lab_test.skip(f"the machine was disturbed in each of {TRIES} flights over {', '.join(unjudged)}")


if __name__ == "__main__":
    main()
