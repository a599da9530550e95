#!/usr/bin/env python3
"""What nodes and programs of the vendors' own say to each other is read by Wireshark's dissector of RTPS without complaint.

Usage: wireshark_test.py NODE TRANSPORT,... PLAIN_PROGRAM...
Ends with 77 where there is no tshark, or no network namespace can be made."""

import collections
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402
from foreign_test import LIMIT_S, Row  # noqa: E402

TOPICS = ("rt/chatter", "rt/latched", "rt/fmu/out/setpoint", "rt/fmu/in/trajectory_setpoint", "rt/words", "rabit/Beat")


def fields(capture, names, which=""):
    """Of each datagram of RTPS for which that holds."""
    argv = ["tshark", "-r", capture, "-Y", f"rtps{which}", "-T", "fields"]
    for name in names:
        argv += ["-e", name]
    lines = subprocess.run(argv, check=True, capture_output=True, text=True).stdout.splitlines()
    return [line.split("\t") for line in lines]


def complaints(capture):
    """What the dissector finds wrong, each with how often."""
    found = collections.Counter()
    for malformed, severity, message in fields(
            capture, ["_ws.malformed", "_ws.expert.severity", "_ws.expert.message"],
            " and (_ws.malformed or _ws.expert.severity >= 6291456)"):  # warnings and errors
        found[f"{malformed} {severity} {message}".strip()] += 1
    return [f"{count} times: {text}" for text, count in found.items()]


# RTPS 2.1, of no vendor, with a DATA that claims to be longer than it is.
BROKEN = b"RTPS\x02\x01\x00\x00" + bytes(12) + b"\x15\x05\x40\x00" + bytes(8)


def is_noticed(folder):
    """Whether it would be said if something were wrong."""
    text = pathlib.Path(folder, "broken.txt")
    text.write_text("000000 " + " ".join(f"{byte:02x}" for byte in BROKEN) + "\n")
    capture = pathlib.Path(folder, "broken.pcap")
    subprocess.run(["text2pcap", "-q", "-u", "40000,7410", text, capture], check=True, capture_output=True)
    return bool(complaints(capture))


def record(node, transports, plain, capture):
    """The exchange of foreign_test.py, each backend beside a program of the other vendor. Returns what failed."""
    with tempfile.TemporaryDirectory(prefix="rabit_wireshark_") as folder, harness.Processes() as processes:
        capturing = processes.start(["dumpcap", "-q", "-i", "lo", "-f", "udp", "-w", capture])
        capturing.wait_for(lambda text: text.startswith("File: "), LIMIT_S)
        rows = [Row(node, transport, program, 5 * i, pathlib.Path(folder))
                for i, (transport, program) in enumerate(zip(transports, reversed(plain)))]
        threads = [threading.Thread(target=row.run) for row in rows]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        capturing.terminate()
        return [row.failure for row in rows if row.failure]


def main():
    node, transports, plain = sys.argv[1], sys.argv[2].split(","), sys.argv[3:]
    harness.enter_namespace_or_skip()
    if not shutil.which("tshark"):
        harness.skip("there is no tshark", "tshark")
    with tempfile.TemporaryDirectory(prefix="rabit_wireshark_") as folder:
        capture = pathlib.Path(folder, "exchange.pcapng")
        failures = record(node, transports, plain, capture)
        datagrams = len(fields(capture, ["frame.number"]))
        named = {topic for (topics,) in fields(capture, ["rtps.param.topicName"], ".param.topicName")
                 for topic in topics.split(",")}
        failures += complaints(capture)
        if not is_noticed(folder):
            failures.append("the dissector does not notice a broken datagram")
        failures += [f"no datagram names {topic}" for topic in TOPICS if topic not in named]
    print("\n".join(failures) or f"{datagrams} datagrams")
    sys.exit(1 if failures or not datagrams else 0)


if __name__ == "__main__":
    main()
