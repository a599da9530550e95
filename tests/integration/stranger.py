#!/usr/bin/env python3
"""Sends nonsense to DDS nodes: random bytes, random bytes behind a sound RTPS header, and mutations of datagrams that
it overhears on the interface. Bounded in count; runs until SIGTERM or its end, whichever is first.

Usage: stranger.py SEED COUNT ADDRESS..."""

import random
import signal
import socket
import sys
import time

MULTICAST = "239.255.0.1"
# The ports of domain 0 (OMG DDSI-RTPS 2.3, 9.6.1): the multicast ports, and the unicast ones of the first
# participants.
MULTICAST_PORTS = (7400, 7401)
UNICAST_PORTS = tuple(range(7410, 7416))
IP_UDP = 0x11
PAUSE_S = 0.002
MOST_KEPT = 400


def overhear(listener, heard):
    """Adds what others have sent and waits at the packet socket: (address, port, payload)."""
    while True:
        try:
            frame, (_, _, kind, *_) = listener.recvfrom(65535)
        except BlockingIOError:
            return
        if kind == socket.PACKET_OUTGOING or len(frame) < 42 or frame[12:14] != b"\x08\x00" or frame[23] != IP_UDP:
            continue
        header = 14 + 4 * (frame[14] & 15)
        payload = frame[header + 8:]
        if payload[:4] == b"RTPS":
            heard.append((socket.inet_ntoa(frame[30:34]), int.from_bytes(frame[header + 2:header + 4], "big"), payload))
            if len(heard) > MOST_KEPT:
                heard.pop(random.randrange(MOST_KEPT // 2))


def mutated(chance, payload):
    """One to four faults: a flipped bit, a byte, a length in the extreme, a piece cut off, doubled or swapped."""
    data = bytearray(payload)
    for _ in range(chance.randint(1, 4)):
        if len(data) < 24:
            break
        # The header of 20 bytes mostly stays sound, so that the receiver reads the bytes behind it.
        at = chance.randrange(0 if chance.random() < 0.1 else 20, len(data))
        what = chance.randrange(6)
        if what == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif what == 1:
            data[at] = chance.randrange(256)
        elif what == 2:
            data[at:at + 4] = chance.choice((b"\xff\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\x7f", b"\0\0\0\x80"))
        elif what == 3:
            del data[at:]
        elif what == 4:
            data[at:at] = data[at:at + chance.randrange(1, 64)]
        else:
            other = chance.randrange(20, len(data))
            data[at], data[other] = data[other], data[at]
    return bytes(data)


def invented(chance):
    body = chance.randbytes(chance.choice((0, 1, 7, 40, 300, 1400)))
    if chance.random() < 0.3:
        return body
    submessage = bytes((chance.choice((1, 6, 7, 8, 9, 0xc, 0xd, 0xe, 0xf, 0x12, 0x13, 0x15, 0x16, 0x55)),
                        chance.randrange(256))) + chance.choice((0, 4, 24, len(body), 65535)).to_bytes(2, "little")
    return b"RTPS\x02\x02\x01\x0f" + chance.randbytes(12) + submessage + body


def main():
    seed, count, *addresses = sys.argv[1:]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    chance = random.Random(int(seed))
    listener = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
    listener.setblocking(False)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    heard = []
    sent = mutations = 0
    for _ in range(int(count)):
        overhear(listener, heard)
        if heard and chance.random() < 0.7:
            # Answers go to the source of a datagram, and sometimes to another address.
            address, port, payload = chance.choice(heard)
            payload = mutated(chance, payload)
            if chance.random() < 0.2:
                address = chance.choice(addresses)
            mutations += 1
        else:
            payload = invented(chance)
            address = chance.choice([*addresses, MULTICAST])
            port = chance.choice(MULTICAST_PORTS if address == MULTICAST else UNICAST_PORTS)
        try:
            sender.sendto(payload, (address, port))
            sent += 1
        except OSError:
            pass  # too long after a mutation, or nobody is there
        time.sleep(PAUSE_S)
    print(f"seed {seed}: {sent} sent, {mutations} of them mutations of what was overheard", flush=True)
    while True:
        time.sleep(1)


if __name__ == "__main__":
    main()
