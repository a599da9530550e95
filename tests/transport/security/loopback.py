"""The UDP datagrams on loopback, and the ports of processes."""

import contextlib
import os
import pathlib
import socket
import struct
import threading

ETHERTYPE_IP = 0x0800
UDP = 17
LARGEST = 1 << 16


class Watch(threading.Thread):
    """Calls `seen(source port, destination port, payload)` for each datagram, on a thread of its own."""

    def __init__(self, seen):
        super().__init__(daemon=True)
        self._seen = seen
        self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(ETHERTYPE_IP))
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self._socket.bind(("lo", ETHERTYPE_IP))
        self.start()

    def run(self):
        while True:
            packet, (_, _, direction, *_) = self._socket.recvfrom(LARGEST)
            header = (packet[0] & 15) * 4
            if direction != socket.PACKET_OUTGOING and packet[9] == UDP:
                source, destination, size = struct.unpack_from("!HHH", packet, header)
                self._seen(source, destination, packet[header + 8:header + size])


def is_in(domain, port):
    """True if participants of the DDS domain receive there (OMG DDSI-RTPS 2.3, 9.6.1.1)."""
    return 7400 + 250 * domain <= port < 7400 + 250 * (domain + 1)


def ports_of(pid):
    """The UDP ports of a process now."""
    sockets = set()
    for each in os.listdir(f"/proc/{pid}/fd"):
        with contextlib.suppress(OSError):  # closed meanwhile
            sockets.add(os.readlink(f"/proc/{pid}/fd/{each}"))
    rows = [line.split() for line in pathlib.Path(f"/proc/{pid}/net/udp").read_text(encoding="ascii").splitlines()[1:]]
    return {int(row[1].split(":")[1], 16) for row in rows if f"socket:[{row[9]}]" in sockets}


def mouth():
    """A socket that sends on loopback, to the group too."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", 0))
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
    return made
