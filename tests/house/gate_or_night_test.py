#!/usr/bin/env python3
"""Each test has exactly one of the labels `gate` and `night`, and a test of the night is in exactly one part.

gate_or_night_test.py CTEST BUILD_FOLDER"""

import json
import pathlib
import subprocess
import sys

NOT_BUILT = "_NOT_BUILT"  # ctest's name for a program whose cases are not known yet


def faults_of(tests, gate_programs):
    """`tests`: (name, labels) of each; a name may come twice, once for each language standard."""
    faults = []
    for name, labels in tests:
        if name.endswith(NOT_BUILT):
            if name[:-len(NOT_BUILT)] in gate_programs:
                faults.append(f"{name}: a program of the gate is not built, so its cases would be left out")
            continue
        if ("gate" in labels) == ("night" in labels):
            faults.append(f"{name}: has {'both' if 'gate' in labels else 'none'} of the labels gate and night")
        elif ("night" in labels) != (sum(label.startswith("night_") for label in labels) == 1):
            faults.append(f"{name}: a test of the night is in one part, and a test of the gate in none")
        elif "gate" in labels and "timed" in labels:
            faults.append(f"{name}: no clock decides in the gate")
    return faults


def test_of_this_test():
    sound = [("a", ["core", "gate"]), ("b", ["night", "night_tool", "timed"]), ("late_NOT_BUILT", [])]
    assert not faults_of(sound, {"core_test"})
    for name, labels in (("none", ["core"]), ("both", ["gate", "night", "night_tool"]), ("no_part", ["night"]),
                         ("two_parts", ["night", "night_tool", "night_soak"]), ("clock", ["gate", "timed"]),
                         ("core_test_NOT_BUILT", [])):
        assert len(faults_of([*sound, (name, labels)], {"core_test"})) == 1, name


def main(ctest, build):
    test_of_this_test()
    listing = subprocess.run((ctest, "--test-dir", build, "--show-only=json-v1"), capture_output=True, text=True, check=True).stdout
    tests = [(test["name"], next((entry["value"] for entry in test.get("properties", []) if entry["name"] == "LABELS"), []))
             for test in json.loads(listing)["tests"]]
    programs = (pathlib.Path(build) / "tests" / "gate_programs.txt").read_text(encoding="utf-8").split()
    faults = faults_of(tests, set(programs))
    print("\n".join(faults) or f"{len(tests)} tests, each in the gate or in one part of the night")
    return 1 if faults or not tests else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
