#!/usr/bin/env python3
"""Speaks in other nodes' names while they find each other: sends damaged copies of what it overhears of discovery to each
node alone, before who has not heard the datagram itself can ask for it again.

Usage: forger.py SEED ADDRESS...
Runs until SIGTERM."""

import random
import re
import select
import signal
import socket
import sys

import stranger

# The writers that announce endpoints, and their readers (RTPS 2.3, 9.3.1.3).
DISCOVERY = tuple(bytes.fromhex(entity) for entity in ("000003c2", "000004c2", "000003c7", "000004c7"))
HEADER = 20
MOST_KEPT = 40
PORT = 7410  # of discovery, of the first participant on a host, in domain 0
PAUSE_S = 0.001
COPIES = 20  # in a row


def damaged(chance, payload):
    """A letter of a name changed, or a bit flipped behind the header."""
    data = bytearray(payload)
    letters = [at for name in re.finditer(rb"[A-Za-z0-9_/]{4,}", payload[HEADER:]) for at in range(*name.span())]
    if letters and chance.random() < 0.8:
        data[HEADER + chance.choice(letters)] ^= 1
    else:
        data[chance.randrange(HEADER, len(data))] ^= 1 << chance.randrange(8)
    return bytes(data)


def main():
    seed, *addresses = sys.argv[1:]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    chance = random.Random(int(seed))
    listener = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(3))
    listener.setblocking(False)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    discovery = []
    while True:
        select.select([listener], [], [], PAUSE_S)
        heard = []
        stranger.overhear(listener, heard)
        discovery += [payload for _, _, payload in heard if any(entity in payload for entity in DISCOVERY)]
        del discovery[:-MOST_KEPT]
        if not discovery:
            continue
        for _ in range(COPIES):
            forged = damaged(chance, chance.choice(discovery))
            for address in addresses:
                try:
                    sender.sendto(forged, (address, PORT))
                except OSError:
                    pass  # nobody is there yet


if __name__ == "__main__":
    main()
