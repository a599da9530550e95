#!/usr/bin/env python3
"""Whole runs of the lab: each fault is seen to come and to go, and a scenario that must fail fails, with the reason.

Usage: lab_test.py RABIT UAV
Exit code 77: this machine allows no namespaces or devices for them."""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
from xml.etree import ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/integration"))
import harness  # noqa: E402
from harness import skip  # noqa: E402

IMPOSSIBLE = 3
LIMIT_S = 400  # only keeps a broken run from hanging the test
# A fault is seen to come and to go within a phase, as a rule after 4 s, so that the machine decides nothing.
# lab_parts_test.py tests verdicts on times. In a scenario 3P are three phases.
PHASE_S = 20

NODES = """nodes:
  uav*: {count: COUNT, command: [UAV, --config, CONFIG, --node, "{node}"]}
"""

LAN = """  writer: {command: [sh, -c, "while :; do if head -c 9000 /dev/zero >> {disk}/file; then echo written; else echo no room; fi; sleep 0.5; done"], plain: true}
  family: {command: [sh, -c, "setsid sh -c 'while :; do echo child; sleep 0.1; done' & sleep 999"], plain: true}
run: 6P
events:
  - {at: 1P, kill: uav2}
  - {at: 1P, kill: family}
  - {at: 1P, freeze: uav3, for: 1P}
  - {at: 1P, disk: {node: writer, full: true}, for: 1P}
  - {at: 1P, send: uav1/MissionControl, type: "Uav::GoHome", value: {reason: low battery}, from: uav4, expect: delivered within 1P}
  - {at: 2P, start: uav2}
  - {at: 3P, clock: {node: uav1, step: -10min}}
  - {at: 3P, cut: [uav1], for: 1P}
expect:
  - all up within 1P
  - family says child within 1P after 0s
  - uav2 lost within 1P after 1P
  - uav2 up within 1P after 2P
  - uav3 lost within 1P after 1P
  - uav3 up within 1P after 2P
  - uav1 lost within 1P after 3P
  - uav1 up within 1P after 4P
  - "uav4/Pose at uav1: age p90 < 1P, after 1P, before 3P"
  - writer says written within 1P after 0s
  - writer says no room within 1P after 1P
  - writer says written within 1P after 2P
"""

# uav1 and uav2 are hidden from each other; since their frames collide, nothing is expected of them. The way from uav3 to uav5
# fails for a while, later the way back does, and uav4 flies away and comes back.
RADIO = """network:
  radio:
    rate: 2Mbit/s
    loss: 2%
    burst: 3
    delay: 10ms
    jitter: 2ms
    capture: true
    hidden: [[uav1, uav2]]
    links: [{from: uav2, to: uav3, loss: 40%, delay: 50ms}]
    range: {from: track.csv, metres: 500}
run: 6P
events:
  - {at: 1P, loss: 100%, from: uav3, to: uav5, for: 1P}
  - {at: 1P, loss: 10%, from: uav2, to: uav3, for: 1s}
  - {at: 1P, delay: 40ms, jitter: 5ms, from: uav5, to: uav3, for: 2s}
  - {at: 3P, deaf: uav3, of: uav5, for: 1P}
  - {at: 5P, rate: 500kbit/s, for: 1s}
  - {at: 5P, outage: radio, for: 1s}
expect:
  - uav3 up within 1P at uav5
  - uav3 lost within 1P after 1P at uav5
  - uav3 up within 1P after 2P at uav5
  - uav5 lost within 1P after 3P at uav3
  - uav5 up within 1P after 4P at uav3
  - uav4 lost within 1P after 1P at uav5
  - uav4 up within 1P after 3P at uav5
  - "radio: used < 50%"
"""
TRACK = f"""time_s,node,x,y,z
0,uav1,0,0,0
0,uav2,50,0,0
0,uav3,0,50,0
0,uav4,0,0,50
0,uav5,0,0,20
{PHASE_S},uav4,0,0,50
{PHASE_S + 1},uav4,5000,0,50
{3 * PHASE_S},uav4,5000,0,50
{3 * PHASE_S + 1},uav4,0,0,50
"""

FAILING = """  quitter: {command: [sh, -c, "sleep 8; echo out of fuel; exit 5"], plain: true}
run: 4P
events:
  - {at: 1P, kill: uav2}
  - {at: 2P, send: uav2/MissionControl, type: "Uav::GoHome", from: uav1, expect: delivered within 1P}
expect:
  - all up within 0.001s
  - uav2 up within 1P after 2P
  - "uav2/Pose at uav1: age p90 < 0.5s"
  - uav1 says nothing of the kind
"""
REASONS = [
    ("no node ends by itself", "quitter ended by itself with 5"),
    ("no node ends by itself", "out of fuel"),
    ("all up within 0.001s", "UP after"),
    ("uav2 up within", "uav1 had uav2 LOST"),
    ("uav2/Pose at uav1", f"`kill uav2` was at {PHASE_S} s"),
    ("uav1 says", "uav1 did not"),
    ("Uav::GoHome to uav2/MissionControl", "no outcome"),
]


# Each fault is still there when the scenario expects that it is not.
FAULTS = """  stopper: {command: [sh, -c, "UAV --config CONFIG --node stopper & sleep 1P; kill -STOP $!; sleep 1P; kill -CONT $!; wait"]}
  watch: {command: [sh, -c, "began=$(date +%s); while :; do test $(date +%s) -ge $began && echo on time || echo back; sleep 0.5; done"], plain: true}
  writer: {command: [sh, -c, "while :; do if head -c 9000 /dev/zero >> {disk}/file; then echo written; else echo no room; fi; sleep 0.5; done"], plain: true}
  rude: {command: [sh, -c, "trap 'exit 3' TERM; while :; do sleep 0.2; done"], plain: true}
network:
  radio: {rate: 10Mbit/s, range: {from: track.csv, metres: 500}}
run: 5P
events:
  - {at: 1P, cut: [uav1], for: 3P}
  - {at: 1P, freeze: uav2, for: 3P}
  - {at: 1P, loss: 100%, from: uav3, to: uav5, for: 3P}
  - {at: 1P, clock: {node: watch, step: -10min}}
  - {at: 1P, disk: {node: writer, full: true}, for: 3P}
expect:
  - uav1 up within 1P after 2P
  - uav2 up within 1P after 2P
  - uav3 up within 1P after 2P at uav5
  - uav4 up within 1P after 2P
  - watch says on time within 1P after 2P
  - watch says back within 1P after 1P
  - writer says written within 1P after 2P
  - no false lost
  - exit codes: 0
"""
FAULT_REASONS = [
    ("uav1 up", f"`cut uav1 for {3 * PHASE_S} s` was at {PHASE_S} s"),
    ("uav2 up", f"`freeze uav2 for {3 * PHASE_S} s` was at {PHASE_S} s"),
    ("uav3 up", f"`loss 100 % from uav3 to uav5 for {3 * PHASE_S} s` was at {PHASE_S} s"),
    ("uav4 up", "out of range"),
    ("watch says on time", f"`clock watch -600 s` was at {PHASE_S} s"),
    ("writer says written", f"`disk full writer for {3 * PHASE_S} s` was at {PHASE_S} s"),
    ("no false lost", "which ran and could be heard"),
    ("exit codes: 0", "rude ended with 3"),
]
NO_START = """  broken: {command: [sh, -c, "echo no such device; exit 2"], plain: true}
run: 2P
expect:
  - all up within 1P
"""
NO_START_REASONS = [("no node ends by itself", "broken ended by itself with 2 at "), ("no node ends by itself", "no such device")]

SMALL = """network:
  radio: {rate: 125kbit/s, loss: 5%, delay: 20ms}
run: 2P
expect:
  - all up within 1P
"""
# A user without root, on a machine where users may open this device, as Debian has it.
AS_USER = ["unshare", "--mount", "sh", "-c", "mount -t tmpfs none /dev/net && mknod -m 666 /dev/net/tun c 10 200 && exec setpriv "
           "--reuid=65534 --regid=65534 --clear-groups \"$@\"", "sh"]
# In a changed root, and where the kernel says so, users make no namespaces.
USER_MAKES_NAMESPACES = [*AS_USER, "unshare", "--user", "--map-root-user", "--net", "true"]
WITHOUT_RIGHTS = ["setpriv", "--bounding-set=-sys_admin"]


class Case:
    """One run in a folder of its own."""

    def __init__(self, folder, name, scenario, count, rabit, uav, before=(), nodes=NODES):
        self.folder = folder / name
        self.folder.mkdir()
        text = re.sub(r"\b(\d)P\b", lambda phases: f"{PHASE_S * int(phases[1])}s", nodes + scenario)
        for word, value in (("COUNT", count), ("UAV", uav), ("CONFIG", ROOT / "examples" / "swarm" / "uav.yaml")):
            text = text.replace(word, str(value))
        (self.folder / f"{name}.yaml").write_text(text, encoding="utf-8")
        (self.folder / "track.csv").write_text(TRACK, encoding="utf-8")
        if before:
            os.chown(self.folder, 65534, 65534)
        self.argv = [*before, rabit, "lab", "run", f"{name}.yaml", "--to", "results"]
        self.results = self.folder / "results"
        self.code, self.said = None, ""

    def run(self):
        done = subprocess.run(self.argv, cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=LIMIT_S, check=False)
        self.code, self.said = done.returncode, done.stdout

    def verdicts(self):
        """{expectation: reason of its failure, or none}"""
        suite = ElementTree.parse(self.results / "junit.xml").getroot()
        return {case.get("name"): (case.find("failure").get("message") if case.find("failure") is not None else None)
                for case in suite.iter("testcase")}


def check(holds, case, what):
    if not holds:
        print(case.said)
        sys.exit(f"{case.folder.name}: {what}")


def check_passed(case):
    check(case.code == 0, case, f"ended with {case.code}, not 0")
    for name in ("report.html", "junit.xml", "log.txt", "radio.json", "flight.mcap", "plots/states.svg", "logs/uav1.log"):
        check((case.results / name).stat().st_size > 0, case, f"no {name}")
    print(f"ok: {case.folder.name}: all {len(case.verdicts())} expectations met")


def check_lan(case):
    check_passed(case)
    lines = (case.results / "log.txt").read_text(encoding="utf-8").splitlines()
    family = [line.split(None, 3)[2:] for line in lines if " family " in line]
    check(family[-1][0] == "lab" and "ended with" in family[-1][1], case, f"a killed node's child goes on: {family[-3:]}")


def check_failed(case, reasons):
    check(case.code == 1, case, f"ended with {case.code}, not 1")
    for name, reason in reasons:
        found = [text for verdict, text in case.verdicts().items() if verdict.startswith(name)]
        check(len(found) == 1 and found[0] and reason in found[0], case, f"`{name}` does not fail by `{reason}`: {found}")
    print(f"ok: {case.folder.name}: each fails for its reason")


def check_faults(case):
    check_failed(case, FAULT_REASONS)
    check([reason for name, reason in case.verdicts().items() if name.startswith("watch says back")] == [None], case, "no step of a clock")


def check_radio(case):
    check_passed(case)
    check((case.results / "radio.pcap").stat().st_size > 1000, case, "no capture")
    nodes = json.loads((case.results / "radio.json").read_text(encoding="utf-8"))["radio"]["counters"]["nodes"]
    check(sum(node["collided"] for node in nodes.values()) > 0, case, "hidden stations did not collide")
    check(nodes["uav3"]["lost"] > nodes["uav2"]["lost"], case, "the link that loses more lost no more")


def check_impossible(case):
    check(case.code == IMPOSSIBLE and "run it as root" in case.said and not case.results.exists(), case,
          f"ended with {case.code}, or without advice")
    print(f"ok: {case.folder.name}: says what to do")


def interrupted(case, number):
    """Nothing is left of a run that is ended: by SIGTERM with a report, by SIGKILL without."""
    with subprocess.Popen(case.argv, cwd=case.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as lab:
        log = case.results / "logs"
        harness.until(lambda: log.exists() or lab.poll() is not None)
        lab.send_signal(number)
        lab.wait(LIMIT_S)
    harness.until(lambda: not any_uses(str(case.results)))
    check((case.results / "report.html").exists() == (number == signal.SIGTERM), case, "a report, or none")
    check(lab.returncode == (130 if number == signal.SIGTERM else -number), case, f"ended with {lab.returncode}")
    print(f"ok: {case.folder.name}: nothing is left")


def any_uses(text):
    """The processes that have this text in their environment or command line."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if text.encode() in (path / "environ").read_bytes() + (path / "cmdline").read_bytes():
                found.append(path.name)
        except OSError:
            pass
    return found


def main():
    rabit, uav = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"rbtlab-{os.getpid()}-"))
    folder.chmod(0o755)
    try:
        lan = Case(folder, "lan", LAN, 4, rabit, uav)
        radio = Case(folder, "radio", RADIO, 5, rabit, uav)
        failing = Case(folder, "failing", FAILING, 2, rabit, uav)
        faults = Case(folder, "faults", FAULTS, 5, rabit, uav)
        no_start = Case(folder, "no_start", NO_START, 2, rabit, uav)
        user = Case(folder, "user", SMALL, 3, rabit, uav, AS_USER)
        refused = Case(folder, "refused", SMALL, 2, rabit, uav, WITHOUT_RIGHTS)
        threads = [threading.Thread(target=case.run) for case in (lan, radio, failing, faults, no_start, user, refused)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if lan.code == IMPOSSIBLE:
            skip(lan.said)
        check_lan(lan)
        check_radio(radio)
        check_failed(failing, REASONS)
        check_faults(faults)
        check_failed(no_start, NO_START_REASONS)
        if subprocess.run(USER_MAKES_NAMESPACES, check=False).returncode == 0:
            check_passed(user)
        else:
            check_impossible(user)
            print("user: not judged, users make no namespaces here")
        check_impossible(refused)
        for name, number in (("terminated", signal.SIGTERM), ("killed", signal.SIGKILL)):
            interrupted(Case(folder, name, LAN, 4, rabit, uav), number)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
