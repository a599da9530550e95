#!/usr/bin/env python3
"""What keys cost on the air: nodes that each write ten small samples a second to all others, with and without keys, in a
network of the test's own. All datagrams on it are counted, with the headers of IP.

Usage: secured_cost.py ODD_KEYS PEER NODES
ODD_KEYS and PEER are programs of this folder. Needs root."""

import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

LIMIT_S = 60
SETTLE_S = 3
STEADY_S = 5
DOMAIN = 5


class Ear(threading.Thread):
    """When a UDP datagram went over the loopback, and how large it was."""

    def __init__(self):
        super().__init__(daemon=True)
        every_protocol = 3
        self.heard = []
        self.socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(every_protocol))
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
        self.socket.bind(("lo", 0))

    def run(self):
        ethernet, udp = 14, 17
        while True:
            frame, address = self.socket.recvfrom(70000)
            if address[2] == socket.PACKET_OUTGOING and len(frame) > ethernet + 20 and frame[ethernet + 9] == udp:
                self.heard.append((time.monotonic(), struct.unpack_from("!H", frame, ethernet + 2)[0]))


def run(programs, transports, count, level, processes, folder):
    odd_keys, peer = programs
    nodes = [(f"node{i}", transports[i % len(transports)]) for i in range(count)]
    subprocess.run([odd_keys, "init", folder, "blue"], check=True)
    for name, transport in nodes:
        subprocess.run([odd_keys, "add", folder, name, transport, str(DOMAIN), "0", "365"], check=True)
    ear = Ear()
    ear.start()
    start = time.monotonic()
    running = [processes.start([peer, transport, name, DOMAIN, "-" if level == "none" else folder / name,
                                "encrypt" if level == "none" else level]) for name, transport in nodes]
    found = start
    for process, (name, _) in zip(running, nodes):
        for other, _ in nodes:
            if other != name:
                when, _ = process.wait_for(lambda text, other=other: text == f"heard {other} 1", LIMIT_S)
                found = max(found, when)
    time.sleep(SETTLE_S)
    begin = time.monotonic()
    time.sleep(STEADY_S)
    end = time.monotonic()
    before = [size for when, size in ear.heard if when < begin]
    steady = [size for when, size in ear.heard if begin <= when < end]
    print(f"{'+'.join(transports):<20} {level:<8} {found - start:5.2f} s  {sum(before) / 1000:6.0f} kB  "
          f"{sum(steady) / STEADY_S / count:6.0f} B/s  {max(before + steady)} B", flush=True)


def main():
    programs, count = sys.argv[1:3], int(sys.argv[3])
    harness.enter_namespace()
    print(f"{count} nodes             level    heard all  until {SETTLE_S} s later  then, each  largest datagram")
    for transports in (["fastdds"], ["cyclonedds"], ["fastdds", "cyclonedds"]):
        for level in ("none", "sign", "encrypt"):
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                run(programs, transports, count, level, processes, pathlib.Path(folder) / "fleet")


if __name__ == "__main__":
    main()
