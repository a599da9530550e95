#!/usr/bin/env python3
"""Somebody announces participants at addresses where nobody has asked for anything. While the announced lease runs, a node
may send there; some time later nothing goes there any more, though the node goes on announcing itself elsewhere.

Usage: forged_traffic_test.py NODE TRANSPORT...
Prints the bytes that came to the addresses, IP headers included. Skipped (exit code 77) where no network
namespace can be made."""

import collections
import os
import pathlib
import re
import socket
import struct
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
import wire as between  # noqa: E402

LIMIT_S = 300
NODES = ("first", "second")
VICTIMS = [f"127.0.0.{number}" for number in range(70, 80)]
PORT = 5555
UNICAST, MULTICAST, LEASE, USER_DATA = (0x31, 0x32), (0x33, 0x48), 0x02, 0x2c
HEADERS = 28
LEASE_S = 5
# Announcements of the nodes themselves, to other addresses, and the time, without a datagram to the victims: that is the end.
QUIET_ANNOUNCEMENTS = 20
QUIET_S = 15


class Loopback:
    """Keeps the newest announcement of a participant in a domain, and counts what goes to the victims."""

    def __init__(self):
        self.announcements = {}  # domain -> the newest one
        self.bytes, self.last = collections.Counter(), {}  # to the victims, by port; when the last one came
        self.since = collections.Counter()  # domain -> announcements since the last datagram to a victim
        self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x0800))
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
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
            if socket.inet_ntoa(ip[16:20]) in VICTIMS:
                self.bytes[port] += size
                self.last[port] = time.monotonic()
                self.since[port - PORT] = 0
            elif between.is_rtps(datagram) and any(each.kind == between.DATA and each.writer == between.ANNOUNCEMENT
                                                   for each in between.submessages(datagram)):
                self.announcements[(port - 7400) // 250] = datagram
                self.since[(port - 7400) // 250] += 1

    def is_quiet(self, domain):
        return (self.since[domain] >= QUIET_ANNOUNCEMENTS
                and time.monotonic() - self.last.get(domain + PORT, 0.0) >= QUIET_S)


def forged(datagram, host, port, with_group):
    """The announcement of another participant, which is no node, at that address."""
    out = bytearray(datagram)
    for each in between.submessages(out):
        if each.kind == between.DATA and each.writer == between.ANNOUNCEMENT:
            found, order = between.parameters(out, each)
            for number, at, _ in found:
                if number in UNICAST:
                    struct.pack_into(order + "I", out, at + 8, port)
                    out[at + 24:at + 28] = socket.inet_aton(host)
                elif number in MULTICAST and not with_group:
                    struct.pack_into(order + "H", out, at, 0)
                elif number == USER_DATA:
                    struct.pack_into(order + "H", out, at, 0)
                elif number == LEASE:
                    struct.pack_into(order + "iI", out, at + 4, LEASE_S, 0)
    prefix = bytes(out[8:20])
    return bytes(out).replace(prefix, prefix[:6] + os.urandom(6))


class Case:
    def __init__(self, node, transport, domain, name, options):
        self.node, self.transport, self.domain, self.name, self.options = node, transport, domain, name, options
        self.loopback = None
        self.failure, self.said = None, ""

    def run(self):
        try:
            with harness.Processes() as processes:
                self.measure(processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def measure(self, processes):
        running = [processes.start([self.node, "--node", name, "--other", other, "--transport", self.transport, "--interface",
                                    "127.0.0.1", "--domain", self.domain, "--no-frame", "--lease", 5, *self.options])
                   for name, other in (NODES, NODES[::-1])]
        for each in running:
            each.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
        harness.until(lambda: self.loopback.announcements.get(self.domain), LIMIT_S)
        port = PORT + self.domain
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sent = 0
            for number in range(10):
                for with_group in (True, False):
                    datagram = forged(self.loopback.announcements[self.domain], VICTIMS[number], port, with_group)
                    for participant in (0, 1):
                        sender.sendto(datagram, ("127.0.0.1", 7410 + 250 * self.domain + 2 * participant))
                        sent += len(datagram) + HEADERS
        harness.until(lambda: self.loopback.bytes[port] > 0, LIMIT_S)
        began = time.monotonic()
        harness.until(lambda: self.loopback.is_quiet(self.domain), LIMIT_S)
        self.said = (f"{sent} bytes of announcements; {self.loopback.bytes[port]} bytes came, the last after "
                     f"{self.loopback.last[port] - began:.0f} s")


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    harness.enter_namespace_or_skip()
    kinds = [("multicast", []), ("peers", ["--peer", "127.0.0.1"]),
             ("peers alone", ["--peer", "127.0.0.1", "--no-multicast"])]
    cases = [Case(node, transport, domain, name, options)
             for domain, (transport, (name, options)) in enumerate((each, kind) for each in transports for kind in kinds)]
    loopback = Loopback()
    for case in cases:
        case.loopback = loopback
    harness.run_at_once(cases)
    for case in cases:
        print(f"{case.transport}, {case.name}: {case.failure or case.said}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
