#!/usr/bin/env python3
"""Aircraft with autopilots beside them in the lab: one over MAVLink, one over DDS. Small programs stand in for ArduPilot, PX4 and
the DDS agent. An autopilot that is killed falls silent, and its aircraft flies on with the next one.

Usage: autopilot_test.py RABIT UAV SIMULATED_PX4
Exit code 77: this machine allows no namespaces or devices for them."""

import os
import pathlib
import sys
import tempfile

import lab_test
from lab_test import check

SCENARIO = """nodes:
  uav1: {command: [UAV, --config, CONFIG, --node, uav1, --mavlink, "udp:{mavlink}"], autopilot: {kind: arducopter, options: [--named, "{node}"]}}
  uav2: {command: [UAV, --config, CONFIG, --node, uav2, --px4, dds], autopilot: {kind: px4-sih, over: dds}}
  ground: {command: [UAV, --config, CONFIG, --node, ground]}
run: 6P
events:
  - {at: 1P, send: uav1/MissionControl, type: "Uav::Goto", value: {latitude_deg: 47.399, longitude_deg: 8.5456, altitude_m: 520, speed_mps: 20}}
  - {at: 2P, kill: "uav1.*"}
  - {at: 4P, start: uav1.autopilot}
expect:
  - all up within 1P
  - "uav1/Pose at ground: rate > 0.1/s, after 1P, before 2P"
  - "uav2/Pose at ground: rate > 0.1/s, after 1P"
  - "uav1.autopilot says began as uav1 within 1P after 0s"
  - "uav1.autopilot says message 86 within 1P after 1P"
  - "uav1/Pose at ground: rate < 0.1/s, after 3P, before 4P"
  - "uav1/Pose at ground: rate > 0.1/s, after 5P"
  - "uav2.agent says waits for PX4"
  - "uav2.autopilot says sihsim_quadx"
  - exit codes: 0
"""

# Says three times a second that it is armed and where it is, in MAVLink 1, and names the messages that it receives.
ARDUCOPTER = '''#!/usr/bin/env python3
import socket, struct, sys, time
EXTRA = {0: 50, 30: 39, 33: 104}
def frame(number, payload, sequence):
    head = struct.pack("<BBBBB", len(payload), sequence % 256, 1, 1, number)
    crc = 0xffff
    for byte in head + payload + bytes([EXTRA[number]]):
        mixed = byte ^ crc & 0xff
        mixed = (mixed ^ mixed << 4) & 0xff
        crc = crc >> 8 ^ mixed << 8 ^ mixed << 3 ^ mixed >> 4
    return b"\\xfe" + head + payload + struct.pack("<H", crc)
argv = sys.argv[1:]
where = argv[argv.index("--serial0") + 1].split(":")
assert where[0] == "udpclient", where
print("began as", argv[argv.index("--named") + 1], flush=True)
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.connect((where[1], int(where[2])))
link.settimeout(0.05)
began, sequence, named = time.monotonic(), 0, set()
while True:
    boot = int(1000 * (time.monotonic() - began))
    for number, payload in ((0, struct.pack("<IBBBBB", 4, 2, 3, 0x81, 4, 3)), (30, struct.pack("<I6f", boot, *[0.0] * 6)),
                            (33, struct.pack("<IiiiihhhH", boot, 473977000, 85456000, 500000, 20000, 0, 0, 0, 0))):
        try:
            link.send(frame(number, payload, sequence))
        except ConnectionRefusedError:
            pass
        sequence += 1
    until = time.monotonic() + 0.3
    while time.monotonic() < until:
        try:
            data = link.recv(2048)
        except OSError:
            continue
        kind = data[7] if data[0] == 0xfd else data[5]
        if kind not in named:
            named.add(kind)
            print("message", kind, flush=True)
'''
PX4 = '#!/bin/sh\necho "$PX4_SIM_MODEL in $PWD"\nexec sleep 9999\n'
AGENT = '#!/bin/sh\necho "$*: waits for PX4"\nexec SIMULATED_PX4 7\n'


def main():
    rabit, uav, px4 = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
    with tempfile.TemporaryDirectory(prefix="rbtpilot-") as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "etc").mkdir()
        for program, text in (("arducopter", ARDUCOPTER), ("px4", PX4), ("MicroXRCEAgent", AGENT.replace("SIMULATED_PX4", px4))):
            (folder / "bin" / program).write_text(text, encoding="utf-8")
            (folder / "bin" / program).chmod(0o755)
        os.environ["PATH"] = f"{folder / 'bin'}:{os.environ['PATH']}"
        case = lab_test.Case(folder, "pilots", SCENARIO, None, rabit, uav, nodes="")
        case.run()
        if case.code == lab_test.IMPOSSIBLE:
            lab_test.skip(case.said)
        check_flight(case)


def check_flight(case):
    if case.code != 0:
        for log in sorted((case.results / "logs").glob("*")):
            print(f"--- {log.name}", *log.read_text(encoding="utf-8").splitlines()[-15:], sep="\n")
    check(case.code == 0, case, f"ended with {case.code}")
    print(case.said)
    check("no node ends by itself" in case.verdicts(), case, f"the verdicts are {sorted(case.verdicts())}")


if __name__ == "__main__":
    main()
