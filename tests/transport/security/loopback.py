"""The UDP datagrams on loopback."""

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
