#!/usr/bin/env python3
"""Flights over three emulated radios are flown again over the same radio, in simulated time, and one of them in real time: p90 of
the ages of each message is about the same, and two replays in simulated time are exactly the same.

Usage: what_if_test.py RABIT UAV GROUND
Exit code 77: this machine allows no namespaces or devices for them."""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402
import lab_test  # noqa: E402
from lab_test import check  # noqa: E402

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
    done = subprocess.run([rabit, "lab", "replay", case.results / "flight.mcap", *options, "--after", AFTER, "--to", folder], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=lab_test.LIMIT_S, check=False)
    check(done.returncode == 0, case, f"replay ended with {done.returncode}: {done.stdout}")


def differences(case, folder, how):
    """The messages whose ages differ in a replay."""
    found = {row["message"]: row for row in json.loads((folder / "what_if.json").read_text(encoding="utf-8"))["messages"]}
    wrong = []
    for message in MESSAGES:
        check(message in found, case, f"the replay has no {message}: {sorted(found)}")
        flown, again = found[message]["recorded_p90"], found[message]["p90"]
        check(flown is not None and again is not None, case, f"no arrival of {message}: {flown}, {again}")
        print(f"{case.folder.name} {message}: age p90 {flown:.3f} s over the emulated radio, {again:.3f} s in {how} time")
        if abs(again - flown) > AS_EMULATED * flown + LATENESS_S:
            wrong.append(f"{message} in {how} time")
    return wrong


def compare(case, rabit, options):
    """The same of a flight."""
    check(case.code == 0, case, f"ended with {case.code}, not 0")
    folders = [case.results / "replayed", case.results / "again"]
    for folder in folders:
        replay(case, rabit, options, folder)
    for name in ("report.html", "what_if.json"):
        check(folders[0].joinpath(name).read_bytes() == folders[1].joinpath(name).read_bytes(), case, f"two {name} of one seed differ")
    wrong = differences(case, folders[0], "simulated")
    if case.folder.name == IN_REAL_TIME:
        replay(case, rabit, [*options, "--real-time"], case.results / "real")
        check((case.results / "real" / "flight.mcap").exists(), case, "no recording of the flight in real time")
        wrong += differences(case, case.results / "real", "real")
    return wrong


def main():
    rabit, uav, ground = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
    station = str(lab_test.ROOT / "examples" / "ground_station" / "ground.yaml")
    with tempfile.TemporaryDirectory(prefix="rbtwhat-") as name:
        cases = {}
        for radio, (network, _) in RADIOS.items():
            text = SCENARIO.replace("GROUND", ground).replace("STATION", station).replace("RADIO", network)
            cases[radio] = lab_test.Case(pathlib.Path(name), radio, text, 3, rabit, uav)
        harness.run_at_once(cases.values())
        for radio, case in cases.items():
            if case.code == lab_test.IMPOSSIBLE:
                print(f"skipped: {case.said}")
                sys.exit(lab_test.SKIPPED)
            wrong = compare(case, rabit, RADIOS[radio][1])
            if wrong and case.repeat_if_disturbed():
                wrong = compare(case, rabit, RADIOS[radio][1])
            check(not wrong, case, f"the ages differ: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
