#!/usr/bin/env python3
"""What the nodes of a fleet say on the air, by kind: starts N of them at once in network namespaces, listens on the switch
between them, and prints for each stretch of time bytes, datagrams and their mean size. Or reads a recording.

Usage: census.py [--nodes N] [--seconds S] [--until S,S,...] [--transport NAME] PROGRAM [ARGUMENT...]
       census.py --pcap FILE
PROGRAM is ledger_node, or one that needs no more than the ARGUMENTs; in them {node} stands for the node's name. --until:
where the stretches end. FILE is what gateway/lab/radio records. Needs root; exit code 77: this machine does not allow
it.

A line says how many destinations (one, all), what RTPS has in it, and whose: SPDP participants, SEDP endpoints, user the
topics. Bytes are those of IP and what is in it; a datagram to one counts once for each receiver, one to all once."""

import argparse
import collections
import ctypes
import os
import pathlib
import socket
import struct
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402

SUBMESSAGES = {0x06: "ACKNACK", 0x07: "HEARTBEAT", 0x08: "GAP", 0x12: "NACKFRAG", 0x13: "HEARTBEATFRAG", 0x15: "DATA",
               0x16: "DATAFRAG"}
SAMPLES = (0x15, 0x16)
CARD = 0xd2  # transport/rtps/CardMessage.h
TO_THE_END = (0x01, 0x09)  # kinds for which a length of 0 does not mean "to the end"
BUILTIN = {0x000100c2: "SPDP", 0x000003c2: "SEDP writers", 0x000004c2: "SEDP readers", 0x000200c2: "liveliness"}
MOST_LINES = 20


def contents(message):
    """What an RTPS message has in it, in words."""
    found = set()
    at = 20
    while at + 4 <= len(message):
        kind, flags = message[at], message[at + 1]
        size = struct.unpack_from("<H" if flags & 1 else ">H", message, at + 2)[0]
        if size == 0 and kind not in TO_THE_END:
            size = len(message) - at - 4
        body = message[at + 4:at + 4 + size]
        if kind == CARD and len(body) >= 20:
            found.update(["card part"] * body[3] + ["requests of cards"] * (body[1] > 0) or ["card summary"])
        elif kind in SUBMESSAGES and len(body) >= 12:
            writer = struct.unpack_from(">I", body, 8 if kind in SAMPLES else 4)[0]
            whose = BUILTIN.get(writer, f"builtin {writer:08x}" if writer & 0xc0 == 0xc0 else "user")
            found.add(f"{whose} {SUBMESSAGES[kind]}")
        at += 4 + size
    return ", ".join(sorted(found)) or "nothing"


def kind_of(frame):
    """(destinations, kind, bytes) of an Ethernet frame; None if it is not IPv4."""
    if frame[12:14] != b"\x08\x00":
        return None
    packet = frame[14:]
    head, size, fragment = (packet[0] & 15) * 4, *struct.unpack_from(">H2xH", packet, 2)
    to = "all" if packet[16] >= 224 else "one"
    if packet[9] != socket.IPPROTO_UDP:
        return to, "not UDP", size
    if fragment & 0x1fff:
        return to, "the rest of a datagram that IP cut", size
    message = packet[head + 8:size]
    return to, contents(message) if message[:4] == b"RTPS" else "not RTPS", size


def table(frames, ends):
    """Of [(seconds, frame), ...]."""
    lines = []
    begin = 0.0
    for end in ends:
        sizes, counts = collections.Counter(), collections.Counter()
        for at, frame in frames:
            found = kind_of(frame) if begin <= at < end else None
            if found:
                sizes[found[:2]] += found[2]
                counts[found[:2]] += 1
        total = sum(sizes.values())
        lines.append(f"{begin:g} to {end:g} s: {total / 1000:.1f} kB, {total / 1000 / (end - begin):.2f} kB/s")
        for key, size in sizes.most_common(MOST_LINES):
            lines.append(f"  {size / 1000:9.1f} kB {size / 1000 / (end - begin):8.2f} kB/s {counts[key]:6d} x "
                         f"{size / counts[key]:5.0f} B  to {key[0]}  {key[1]}")
        begin = end
    return "\n".join(lines)


class Capture(threading.Thread):
    """Hears all that the switch of a Field carries. A frame that it floods is heard once."""

    RECEIVE_BUFFER_FORCE = 33
    ALL_PROTOCOLS = 3
    NETWORK_NAMESPACE = 0x40000000
    BUFFER = 64 << 20

    def __init__(self, space):
        super().__init__(daemon=True)
        self.frames = []
        self._space = space
        self._ending = threading.Event()
        self._ready = threading.Event()
        self._error = None

    def __enter__(self):
        self.start()
        self._ready.wait()
        if self._error:
            raise self._error
        return self

    def __exit__(self, *_):
        self._ending.set()
        self.join()

    def run(self):
        try:
            heard = self._open()
        except OSError as error:
            self._error = error
            return
        finally:
            self._ready.set()
        with heard:
            while not self._ending.is_set():
                try:
                    self.frames.append((time.monotonic(), heard.recv(65536)))
                except TimeoutError:
                    continue

    def _open(self):
        # Changes the namespace of this thread alone.
        space = os.open(f"/run/netns/{self._space}", os.O_RDONLY)
        try:
            if ctypes.CDLL(None, use_errno=True).setns(space, self.NETWORK_NAMESPACE) != 0:
                raise OSError(ctypes.get_errno(), "setns")
        finally:
            os.close(space)
        heard = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(self.ALL_PROTOCOLS))
        heard.setsockopt(socket.SOL_SOCKET, self.RECEIVE_BUFFER_FORCE, self.BUFFER)
        heard.bind(("br0", 0))
        heard.settimeout(0.2)
        return heard


def run(options):
    """[(seconds since the start, frame), ...]"""
    nodes = ["ground"] + [f"uav{number}" for number in range(1, options.nodes)]
    with field.Field(nodes) as ground:
        field.run("ip", "-n", ground.space("switch"), "link", "set", "br0", "promisc", "on")
        with Capture(ground.space("switch")) as capture:
            begin = time.monotonic()
            for node in nodes:
                arguments = [argument.replace("{node}", node) for argument in options.arguments]
                if pathlib.Path(options.program).name.startswith("ledger_node"):
                    ledger = os.path.join(ground.folder, node + ".ledger")
                    arguments = ["--node", node, "--ledger", ledger, "--transport", options.transport, *arguments]
                ground.start(node, [options.program, *arguments])
            time.sleep(options.seconds)
            ended = [node for node in nodes if not ground.processes[node].running()]
        if ended:
            raise SystemExit(f"{', '.join(ended)} ended by itself")
        return [(at - begin, frame) for at, frame in capture.frames]


def read(path):
    """The frames of a pcap file, of microseconds or nanoseconds, in this machine's order of bytes."""
    data = pathlib.Path(path).read_bytes()
    unit = {0xa1b2c3d4: 1e6, 0xa1b23c4d: 1e9}[struct.unpack_from("=I", data)[0]]
    frames, at = [], 24
    while at + 16 <= len(data):
        seconds, part, size = struct.unpack_from("=III", data, at)
        frames.append((seconds + part / unit, data[at + 16:at + 16 + size]))
        at += 16 + size
    return [(when - frames[0][0], frame) for when, frame in frames]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nodes", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=15)
    parser.add_argument("--until", default="2,5")
    parser.add_argument("--transport", default="fastdds")
    parser.add_argument("--pcap")
    parser.add_argument("program", nargs="?")
    parser.add_argument("arguments", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if bool(options.pcap) == bool(options.program):
        parser.error("either a program or a recording")
    with field.skipping():
        frames = read(options.pcap) if options.pcap else run(options)
    last = max([0.001] + [at + 1e-6 for at, _ in frames]) if options.pcap else options.seconds
    print(table(frames, [end for end in map(float, options.until.split(",")) if end < last] + [last]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
