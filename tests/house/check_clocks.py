#!/usr/bin/env python3
"""Tests wait for what happens, not for a time, and none makes up for what the machine did meanwhile. A program that needs the
clock, or sleeps, is in the list below, with its reason.

Usage: check_clocks.py ROOT"""

import pathlib
import re
import sys
import tempfile

# Whole folders that are not looked into.
ELSEWHERE = ("tests/night/", "tests/house/")
# Faults of real programs last for a time, and benchmarks measure. These make up for nothing either.
TIMED = ("tests/integration/", "tests/bench/")
HELPER = "a helper: waits for what nothing tells, and ends a test that hangs"
PACE = "a program that posts at a rate"
CLOCK = "a test of a clock"
BOUND = "no machine is too slow for it: a time is at least so long, or nothing is older than the test"
FAULT = "how long a fault lasts"
QUIET = "nothing tells that nothing comes any more"
MEASURES = "a measurement"
ANY_TIME = "what it does may come at any time"
MAY = {
    "tests/Eventually.h": HELPER,
    "tests/gate/flights.py": HELPER,
    "tests/gateway/python/conftest.py": HELPER,
    "tests/examples/black_box/black_box_test.sh": HELPER,
    "tests/examples/demo_test.sh": HELPER,
    "tests/examples/ground_problems_test.sh": HELPER,
    "tests/examples/uav_options_test.sh": HELPER,
    "tests/examples/web/web_options_test.sh": HELPER,
    "tests/foreign/plain_fastdds.cpp": PACE,
    "tests/gateway/lab/autopilot_test.py": PACE,
    "tests/gateway/python/ping.cpp": PACE,
    "tests/gateway/python/test_examples.py": PACE,
    "tests/gateway/python/test_lab.py": PACE,
    "tests/gateway/python/test_loop.py": PACE,
    "tests/gateway/python/test_outside.py": PACE,
    "tests/gateway/python/test_record.py": PACE,
    "tests/gateway/tool/FleetSessionTest.cpp": PACE,
    "tests/opponent/main.cpp": PACE,
    "tests/transport/interop/interop_node.cpp": PACE,
    "tests/transport/envelope/SealedSessionTest.cpp": ANY_TIME,
    "tests/transport/thin/thin_node.cpp": PACE,
    "tests/core/ClockTest.cpp": CLOCK,
    "tests/core/SuspensionTest.cpp": CLOCK,
    "tests/core/UtilitiesTest.cpp": CLOCK,
    "tests/core/WallClockTest.cpp": CLOCK,
    "tests/core/RabitManagerFailureTest.cpp": BOUND,
    "tests/core/RabitManagerPeriodTest.cpp": BOUND,
    "tests/gateway/tool/play_test.py": BOUND,
    "tests/gateway/tool/viewer/viewer_test.py": BOUND,
    "tests/examples/overload_test.py": FAULT,
    "tests/transport/interop/late_network_test.py": FAULT,
    "tests/transport/interop/outage_test.py": FAULT,
    "tests/transport/interop/suspension_test.py": FAULT,
    "tests/foreign/ring_test.py": QUIET,
    "tests/transport/faults/vendor_faults_test.py": QUIET,
    "tests/transport/interop/forged_traffic_test.py": QUIET,
    "tests/gateway/python/test_library.py": MEASURES,
    "tests/opponent/strangers_test.py": MEASURES,
    "tests/simulation/common/SeedRunner.cpp": MEASURES,
    "tests/transport/thin/thin_test.py": MEASURES,
    "tests/gateway/python/test_stop.py": ANY_TIME,
    "tests/gateway/python/test_stress.py": ANY_TIME,
}
CPP = r"\bsleep_(?:for|until)\b|\b(?:u|nano)sleep\(|(?<![\w:.])sleep\(|\b\w*[cC]lock::now\(\)"
PYTHON_CLOCK = r"time\.(?:monotonic|time|perf_counter)\(\)"
NEEDS = {
    ".cpp": CPP, ".h": CPP, ".c": CPP,
    # A reading marks a moment, or is shown; compared, it decides.
    ".py": rf"\btime\.sleep\(|\basyncio\.sleep\((?!0\))|[<>].*{PYTHON_CLOCK}|{PYTHON_CLOCK}.*[<>]",
    ".sh": r"(?:^\s*|[;&] |do )sleep\b",
}
EXCUSES = re.compile(r"\bharness\.(?:Waits|Idle)\b|^class (?:Waits|Idle):|\bTRIES\b|\bbusy machine|"
                     r"\bmachine (?:is|was|may be) (?:busy|disturbed)\b|\bis_busy\b")


def violations(root):
    needless = dict(MAY)
    for path in sorted((root / "tests").rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in NEEDS or name.startswith(ELSEWHERE) or "node_modules" in name:
            continue
        needs = re.compile(NEEDS[path.suffix])
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if EXCUSES.search(line):
                yield f"{name}:{number}: makes up for the machine: {line.strip()}"
            if name.startswith(TIMED) or not needs.search(line):
                continue
            needless.pop(name, None)
            if name not in MAY:
                yield f"{name}:{number}: a time decides it, or it sleeps: {line.strip()}"
    yield from (f"{name}: needs no clock any more, so it must leave the list of check_clocks.py" for name in needless)


def notices_violations():
    """Each of these lines, in a file of its own, is one."""
    lines = {"a.py": "time.sleep(1)", "b.py": "await asyncio.sleep(0.1)", "c.py": "while time.monotonic() < end:",
             "d.cpp": "std::this_thread::sleep_for(1ms);", "e.h": "const auto now = Clock::now();", "f.sh": "    sleep 0.1",
             "g.py": "with harness.Waits(pids) as waits:", "bench/h.py": "TRIES = 3  # on a busy machine",
             "integration/l.py": "class Idle:"}
    fine = {"i.py": "since = time.monotonic()", "j.py": "await asyncio.sleep(0)", "bench/k.py": "time.sleep(5)", "integration/m.py": "time.sleep(5)"}
    with tempfile.TemporaryDirectory() as folder:
        for name, line in {**lines, **fine}.items():
            path = pathlib.Path(folder, "tests", name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(line + "\n", encoding="utf-8")
        found = {text.split(":")[0] for text in violations(pathlib.Path(folder))}
    return found == {"tests/" + name for name in lines} | set(MAY)


def main():
    assert notices_violations(), "a violation is not noticed"
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
