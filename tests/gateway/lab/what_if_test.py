#!/usr/bin/env python3
"""Flights over three emulated radios are flown again over the same radio, in simulated time, and one of them in real time: each
message arrives again, and two replays in simulated time are exactly the same. TwoMediaTest.cpp compares the two radios.

Usage: what_if_test.py RABIT UAV GROUND
Exit code 77: this machine allows no namespaces or devices for them."""

import json
import pathlib
import subprocess
import sys
import tempfile

import lab_test
from lab_test import check

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


def replay(case, rabit, options, folder):
    """The exit code of a replay and what it said."""
    done = subprocess.run([rabit, "lab", "replay", case.results / "flight.mcap", *options, "--after", AFTER, "--to", folder], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=lab_test.LIMIT_S, check=False)
    return done.returncode, done.stdout


def compare(case, folder, how):
    """Shows the ages of a replay beside those of the flight. Each message has arrived in both."""
    found = {row["message"]: row for row in json.loads((folder / "what_if.json").read_text(encoding="utf-8"))["messages"]}
    for message in MESSAGES:
        flown, again = (found.get(message, {}).get(key) for key in ("recorded_p90", "p90"))
        check(flown is not None and again is not None, case, f"{message} in {how} time did not arrive: p90 {flown} and {again}")
        print(f"{case.folder.name} {message}: age p90 {flown:.3f} s over the emulated radio, {again:.3f} s in {how} time")


def judge(case, rabit, options):
    check(case.code == 0, case, f"the flight ended with {case.code}")
    folders = [case.results / "replayed", case.results / "again"]
    for folder in folders:
        code, said = replay(case, rabit, options, folder)
        check(code == 0, case, f"the replay ended with {code}: {said}")
    for name in ("report.html", "what_if.json"):
        check(folders[0].joinpath(name).read_bytes() == folders[1].joinpath(name).read_bytes(), case, f"two {name} of one seed differ")
    compare(case, folders[0], "simulated")
    if case.folder.name == IN_REAL_TIME:
        folder = case.results / "real"
        code, said = replay(case, rabit, [*options, "--real-time"], folder)
        check(code == 0, case, f"the replay in real time ended with {code}: {said}")
        check((folder / "flight.mcap").exists(), case, "no recording of the flight in real time")
        compare(case, folder, "real")


def main():
    rabit, uav, ground = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
    station = str(lab_test.ROOT / "examples" / "ground_station" / "ground.yaml")
    with tempfile.TemporaryDirectory(prefix="rbtwhat-") as name:
        cases = []
        for radio, (network, _) in RADIOS.items():
            text = SCENARIO.replace("GROUND", ground).replace("STATION", station).replace("RADIO", network)
            cases.append(lab_test.Case(pathlib.Path(name), radio, text, 3, rabit, uav))
        lab_test.harness.run_at_once(cases)
        if cases[0].code == lab_test.IMPOSSIBLE:
            lab_test.skip(cases[0].said)
        for case, (_, options) in zip(cases, RADIOS.values()):
            judge(case, rabit, options)


if __name__ == "__main__":
    main()
