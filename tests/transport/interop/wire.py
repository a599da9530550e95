"""Two namespaces whose only way to each other leads through this process, which may keep and change every datagram; and what
is to be known of RTPS for that."""

import pathlib
import select
import socket
import struct
import sys
import threading

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402

ETHERNET = 14
UDP = 17
HEADER = 20  # of RTPS
DATA, ANNOUNCEMENT = 0x15, bytes.fromhex("000100c2")


class Submessage:
    """One of a datagram: where it begins and ends, and what it is."""

    def __init__(self, datagram, at):
        self.at, self.kind = at, datagram[at]
        self.order = "<" if datagram[at + 1] & 1 else ">"
        length = struct.unpack_from(self.order + "H", datagram, at + 2)[0]
        self.end = min(at + 4 + length if length or self.kind in (1, 9) else len(datagram), len(datagram))
        self.writer = bytes(datagram[at + 12:at + 16]) if self.kind == DATA else b""


def submessages(datagram):
    found, at = [], HEADER
    while at + 4 <= len(datagram):
        found.append(Submessage(datagram, at))
        at = found[-1].end
    return found


def is_rtps(datagram):
    return len(datagram) > HEADER + 4 and datagram[:4] == b"RTPS"


def parameter_list(datagram, at, end, order):
    """(number, where it begins, how long its value is) of each parameter, the last one included."""
    while at + 4 <= end:
        number, length = struct.unpack_from(order + "HH", datagram, at)
        yield number, at, 0 if number == 1 else length
        if number == 1:
            return
        at += 4 + length


def parameters(datagram, announcement):
    """The same of an announcement, and its order of bytes."""
    at = announcement.at + 4 + 20
    if datagram[announcement.at + 1] & 2:
        *_, (_, last, _) = parameter_list(datagram, at, announcement.end, announcement.order)
        at = last + 4
    order = "<" if datagram[at + 1] & 1 else ">"
    return list(parameter_list(datagram, at + 4, announcement.end, order)), order


class Wire(field.Field):
    """with Wire(["alpha", "bravo"]) as wire: wire.start(...); wire.change = what is called with the name of who sent a
    datagram and the datagram, and returns those that go on in its place"""

    def __init__(self, nodes, number):
        super().__init__(nodes)
        self._number = number
        self._sockets = {}
        self._stopped = False
        self._thread = None
        self.change = lambda _, datagram: [datagram]

    def space(self, name):
        return f"{self._prefix}{self._number}{name}"

    def _connect(self):
        for node in self.nodes:
            self._make_space(node)
            near = f"w{self._number}{node[:8]}"
            # The MTU is larger than any datagram, so that none is fragmented.
            field.run("ip", "link", "add", near, "mtu", "9000", "type", "veth", "peer", "name", "eth0", "mtu", "9000",
                      "netns", self.space(node))
            field.run("ip", "link", "set", near, "up")
            self._switch_on(node)
            every_protocol = 3
            self._sockets[node] = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(every_protocol))
            self._sockets[node].setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
            self._sockets[node].bind((near, 0))
        self._thread = threading.Thread(target=self._relay, daemon=True)
        self._thread.start()

    def other(self, node):
        return self.nodes[1 - self.nodes.index(node)]

    def _relay(self):
        while not self._stopped:
            for ready in select.select(self._sockets.values(), [], [], 0.2)[0]:
                frame, address = ready.recvfrom(20000)
                if address[2] == socket.PACKET_OUTGOING:
                    continue
                node = next(name for name, each in self._sockets.items() if each is ready)
                for out in self._changed(node, frame):
                    self._sockets[self.other(node)].send(out)

    def _changed(self, node, frame):
        ip = ETHERNET + 4 * (frame[ETHERNET] & 15)
        if frame[12:14] != b"\x08\x00" or frame[ETHERNET + 9] != UDP or not is_rtps(frame[ip + 8:]):
            return [frame]
        # Excludes the padding of short frames.
        size = struct.unpack_from("!H", frame, ip + 4)[0]
        frames = []
        for datagram in self.change(node, frame[ip + 8:ip + size]):
            out = bytearray(frame[:ip + 8]) + datagram
            struct.pack_into("!H", out, ip + 4, 8 + len(datagram))
            struct.pack_into("!H", out, ip + 6, 0)  # no checksum
            struct.pack_into("!H", out, ETHERNET + 2, len(out) - ETHERNET)
            struct.pack_into("!H", out, ETHERNET + 10, 0)
            struct.pack_into("!H", out, ETHERNET + 10, self._checksum(out[ETHERNET:ip]))
            frames.append(bytes(out))
        return frames

    @staticmethod
    def _checksum(header):
        total = sum(struct.unpack(f"!{len(header) // 2}H", header))
        while total >> 16:
            total = (total & 0xffff) + (total >> 16)
        return ~total & 0xffff

    def _remove(self):
        self._stopped = True
        if self._thread:
            self._thread.join()
        for each in self._sockets.values():
            each.close()
        super()._remove()
