#!/usr/bin/env python3
"""What two nodes send to an address where nobody has asked for it, because somebody who is none of them has announced
participants there.

Usage: forged_announcement_cost.py RABIT NODE PARTICIPANTS TRANSPORT...
NODE is ../interop's. Sends each node one announcement for each participant, and prints for each backend, with keys and
without, the bytes that went in and came out, IP headers included. Who begins a handshake is who has the smaller GUID, and
whether that is the node is left to chance: run it a few times."""

import os
import pathlib
import re
import socket
import struct
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
import wire as between  # noqa: E402
from interop_keys import make_keys  # noqa: E402

LIMIT_S = 30
NODES = ("first", "second")
VICTIM = ("127.0.0.77", 5555)
LOCATORS = (0x31, 0x32, 0x33, 0x48)
HEADERS = 28
AFTER_S = (5, 20, 40)


class Loopback:
    """Keeps the newest announcement of a participant, and counts what goes to the victim."""

    def __init__(self):
        self.announcement, self.bytes = None, 0
        self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x0800))
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        while True:
            frame, address = self._socket.recvfrom(70000)
            ip = frame[between.ETHERNET:]
            if address[2] == socket.PACKET_OUTGOING or ip[9] != between.UDP:
                continue
            udp = 4 * (ip[0] & 15)
            size, port = struct.unpack_from("!H", ip, 2)[0], struct.unpack_from("!H", ip, udp + 2)[0]
            datagram = ip[udp + 8:size]
            if (socket.inet_ntoa(ip[16:20]), port) == VICTIM:
                self.bytes += size
            elif between.is_rtps(datagram) and any(each.kind == between.DATA and each.writer == between.ANNOUNCEMENT
                                                   for each in between.submessages(datagram)):
                self.announcement = datagram


def forged(datagram):
    """The announcement of another participant, at the victim's address."""
    out = bytearray(datagram)
    for each in between.submessages(out):
        if each.kind == between.DATA and each.writer == between.ANNOUNCEMENT:
            found, order = between.parameters(out, each)
            for number, at, _ in found:
                if number in LOCATORS:
                    struct.pack_into(order + "I", out, at + 8, VICTIM[1])
                    out[at + 24:at + 28] = socket.inet_aton(VICTIM[0])
    prefix = bytes(out[8:20])
    return bytes(out).replace(prefix, prefix[:6] + os.urandom(6))


def measure(programs, participants, transport, secured):
    rabit, node = programs
    with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
        loopback = Loopback()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as victim, \
                socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            victim.bind(VICTIM)
            if secured:
                make_keys(rabit, pathlib.Path(folder), [(name, transport) for name in NODES], harness.domain())
            running = [processes.start([node, "--node", name, "--other", other, "--transport", transport, "--interface",
                                        "127.0.0.1", "--domain", harness.domain(), "--no-frame",
                                        *(["--keys", pathlib.Path(folder) / "keys" / name] if secured else [])])
                       for name, other in (NODES, NODES[::-1])]
            for each in running:
                each.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
            true = harness.until(lambda: loopback.announcement, LIMIT_S)
            put_in, begin = 0, time.monotonic()
            for _ in range(participants):
                datagram = forged(true)
                for port in (7410, 7412):
                    sender.sendto(datagram, ("127.0.0.1", port + 250 * harness.domain()))
                    put_in += len(datagram) + HEADERS
                time.sleep(0.02)
            came = []
            for after in AFTER_S:
                time.sleep(max(0.0, begin + after - time.monotonic()))
                came.append(f"{loopback.bytes / 1000:.1f} kB ({loopback.bytes / put_in:.1f} times) after {after} s")
            print(f"{transport}, {'keys' if secured else 'no keys'}: {put_in / 1000:.1f} kB in; out {', '.join(came)}")
            assert all(each.running() for each in running)


def main():
    programs, participants, transports = sys.argv[1:3], int(sys.argv[3]), sys.argv[4:]
    harness.enter_namespace()
    for transport in transports:
        for secured in (False, True):
            measure(programs, participants, transport, secured)


if __name__ == "__main__":
    main()
