#!/usr/bin/env python3
"""Somebody in between damages or forges one thing, once, while two members meet. They must meet all the same. And two
that have met stay together, whatever comes without keys.

Usage: spoiled_meeting_test.py ODD_KEYS PEER TRANSPORT...
ODD_KEYS and PEER are programs of this folder. Needs root."""

import contextlib
import pathlib
import re
import struct
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import field  # noqa: E402
import harness  # noqa: E402
import wire as between  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 200
DOMAIN = 3
# Longer than LIMIT_S: no node is forgotten because it was silent.
LEASE_S = 300
NODES = ("alpha", "bravo")
STEPS = (b"DDS:Auth:PKI-DH:1.0+Req", b"DDS:Auth:PKI-DH:1.0+Reply", b"DDS:Auth:PKI-DH:1.0+Final")
IDENTITY_TOKEN, PERMISSIONS_TOKEN = 0x1001, 0x1002
SECURITY = (0x1001, 0x1002, 0x1005, 0x1006)
UNICAST_LOCATORS = (0x31, 0x32)
LEASE = 2
NOBODYS_PORT = 9
DATA_FRAGMENT = 0x16
# A minute's: twice as long as an attempt to meet takes (AuthenticationRetries::Stalled).
SAMPLES_UNDER_ATTACK = 600


class Case:
    """Two members of one pair of backends, between which one thing is spoiled."""

    def __init__(self, programs, transports, number, name, spoil):
        self.odd_keys, self.peer = programs
        self.transports, self.number, self.name, self.spoil = dict(zip(NODES, transports)), number, name, spoil
        self.wire = None
        self.failure = None
        self.spoiled = 0
        self.step = {}  # node -> the step of the handshake that it has sent last
        self.lines = []
        self.took = 0.0

    def __str__(self):
        return f"{self.name}, {'+'.join(self.transports.values())}"

    def run(self):
        try:
            self.wire.change = self.change
            fleet = pathlib.Path(self.wire.folder) / "fleet"
            subprocess.run([self.odd_keys, "init", fleet, "blue"], check=True)
            for node, transport in self.transports.items():
                subprocess.run([self.odd_keys, "add", fleet, node, transport, str(DOMAIN), "0", "365"], check=True)
            began = time.monotonic()
            nodes = {node: self.wire.start(node, [self.peer, transport, node, DOMAIN, fleet / node, "encrypt", "eth0",
                                                  LEASE_S])
                     for node, transport in self.transports.items()}
            try:
                self.meet(nodes)
                self.took = time.monotonic() - began
            finally:
                for node, process in nodes.items():
                    self.lines += [f"{when - began:6.1f} {node}: {text}" for when, text in process.lines
                                   if not text.startswith("heard")]
                    process.kill()
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def meet(self, nodes):
        for node, process in nodes.items():
            process.wait_for(re.compile(f"heard {self.wire.other(node)} \\d+").fullmatch, LIMIT_S)

    def change(self, node, datagram):
        out = bytearray(datagram)
        if self.spoiled == 0 and self.spoil(self, node, out):
            self.spoiled += 1
        return [out]


def is_of_handshake(datagram):
    return any(each.kind in (between.DATA, DATA_FRAGMENT) and datagram[each.at + 12:each.at + 16] == between.HANDSHAKE
               for each in between.submessages(datagram))


def handshake(step, name, offset=40):
    """Another byte in a property of one message of the handshake."""
    def spoil(case, node, datagram):
        if not is_of_handshake(datagram):
            return False
        for each in STEPS:
            if bytes(datagram).find(each) >= 0:
                case.step[node] = each
        at = bytes(datagram).find(name + b"\0")
        if case.step.get(node) != STEPS[step] or at < 0 or at + offset >= len(datagram):
            return False
        datagram[at + offset] ^= 0x10
        return True
    return spoil


def change_announcement(datagram, change):
    """Calls change(datagram, number, at, length, order) for each parameter; true if one call returned true."""
    for each in between.submessages(datagram):
        if each.kind == between.DATA and each.writer == between.ANNOUNCEMENT:
            found, order = between.parameters(datagram, each)
            return any([change(datagram, number, at, length, order) for number, at, length in found])
    return False


def announcement(change):
    """The first announcement of bravo."""
    return lambda _, node, datagram: node == "bravo" and change_announcement(datagram, change)


def token(which):
    def change(datagram, number, at, length, _):
        if number == which:
            datagram[at + 4 + length // 2] ^= 0x10
        return number == which
    return change


def without_security(datagram, number, at, length, order):
    if number in SECURITY:
        struct.pack_into(order + "H", datagram, at, 0)
    if number == 0x58 and length == 4:
        struct.pack_into(order + "I", datagram, at + 4, struct.unpack_from(order + "I", datagram, at + 4)[0] & 0xffff)
    return number in SECURITY


def moved(datagram, number, at, _, order):
    if number in UNICAST_LOCATORS:
        struct.pack_into(order + "I", datagram, at + 8, NOBODYS_PORT)
    return number in UNICAST_LOCATORS


def with_fewer_addresses(datagram, number, at, _, order):
    if number == UNICAST_LOCATORS[0]:
        struct.pack_into(order + "H", datagram, at, 0)
    return number == UNICAST_LOCATORS[0]


def with_another_lease(datagram, number, at, _, order):
    if number == LEASE:
        struct.pack_into(order + "I", datagram, at + 4, LEASE_S - 1)
    return number == LEASE


class Unconfirmed(Case):
    """The same. What was announced falsely could be used, and must not last all the same: both sides begin anew. Each
    announcement is false until alpha listens and a handshake begins, since the first one may be lost."""

    listens = begun = False

    def change(self, node, datagram):
        out = bytearray(datagram)
        self.listens |= node == "alpha" and any(each.writer == between.ANNOUNCEMENT for each in between.submessages(out))
        if not self.begun and self.spoil(self, node, out):
            self.spoiled += 1
        self.begun |= self.listens and self.spoiled > 0 and is_of_handshake(out)
        return [out]

    def meet(self, nodes):
        super().meet(nodes)
        assert any("begin anew" in text for process in nodes.values() for _, text in process.lines), \
            "what was announced falsely was believed"


class Healthy(Case):
    """Two members that have met, between which somebody forges announcements and messages of handshakes."""

    def __init__(self, programs, transports, number):
        super().__init__(programs, transports, number, "forgeries after the handshake", None)
        self.handshakes = {node: [] for node in NODES}
        self.met = False

    def meet(self, nodes):
        super().meet(nodes)
        self.met, since = True, time.monotonic()
        for node, process in nodes.items():
            other = self.wire.other(node)
            process.wait_for(re.compile(f"heard {other} {SAMPLES_UNDER_ATTACK}").fullmatch, LIMIT_S)
            lines = [text for when, text in process.lines
                     if when > since and (text == f"gone {other}" or "begin anew" in text)]
            assert not lines, f"{node} lost {other}: {lines}"
        assert self.spoiled > 0, "nothing was forged"

    def change(self, node, datagram):
        if not self.met:
            if is_of_handshake(datagram):
                self.handshakes[node].append(bytes(datagram))
            return [datagram]
        forged = []
        for change in (moved, without_security):
            out = bytearray(datagram)
            if change_announcement(out, change):
                forged.append(out)
        if not forged:
            return [datagram]
        self.spoiled += 1
        return [*forged, *(altered(each) for each in self.handshakes[node]), datagram]


def altered(message):
    out = bytearray(message)
    for name in (b"c.pdata\0", b"c.perm\0", b"challenge1\0"):
        at = bytes(out).find(name)
        if 0 <= at < len(out) - 70:
            out[at + 60] ^= 0x10
    return out


CASES = [("request: permissions", handshake(0, b"c.perm")), ("request: challenge", handshake(0, b"challenge1", 20)),
         ("reply: challenge", handshake(1, b"challenge2", 20)), ("final: signature", handshake(2, b"signature")),
         ("identity token", announcement(token(IDENTITY_TOKEN))),
         ("permissions token", announcement(token(PERMISSIONS_TOKEN))),
         ("no security", announcement(without_security)), ("another address", announcement(moved))]
UNCONFIRMED = [("fewer addresses", announcement(with_fewer_addresses)),
               ("another lease", announcement(with_another_lease))]


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    pairs = [(one, other) for one in transports for other in transports]
    spoils = [(Case, *each) for each in CASES] + [(Unconfirmed, *each) for each in UNCONFIRMED]
    cases = [kind(programs, pair, number, name, spoil) for number, (kind, name, spoil, pair)
             in enumerate((*each, pair) for each in spoils for pair in pairs)]
    cases += [Healthy(programs, pair, len(cases) + number) for number, pair in enumerate(pairs)]
    with field.skipping():
        with contextlib.ExitStack() as wires:
            for case in cases:
                case.wire = wires.enter_context(between.Wire(NODES, case.number))
            harness.run_at_once(cases)
    for case in cases:
        print(f"{case}: spoiled {case.spoiled}; {case.failure or f'met after {case.took:.1f} s'}")
        if case.failure:
            for line in case.lines:
                print(f"    {line}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
