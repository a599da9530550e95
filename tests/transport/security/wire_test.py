#!/usr/bin/env python3
"""Somebody in between: two members whose every datagram goes through the test, which repeats and changes them. Each thing
is first done to members without keys, or undone in the end, to show that it does work where the door is open.

Usage: wire_test.py ODD_KEYS PEER TRANSPORT...
ODD_KEYS and PEER are programs of this folder. Needs root."""

import contextlib
import pathlib
import re
import struct
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import field  # noqa: E402
import harness  # noqa: E402
import wire as between  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
DOMAIN = 3
LEASE_S = 4
NODES = ("alpha", "bravo")
FORGED = b"ALPHA"


class Count:
    """Counts, and lets one wait for a number."""

    def __init__(self):
        self._count = 0
        self._changed = threading.Condition()

    def add(self):
        with self._changed:
            self._count += 1
            self._changed.notify_all()

    def wait_for_more(self, more):
        with self._changed:
            wanted = self._count + more
            if not self._changed.wait_for(lambda: self._count >= wanted, LIMIT_S):
                raise AssertionError(f"{self._count} of {wanted} datagrams came")


class Case:
    """Two members, or two nodes without keys, of one pair of backends."""

    def __init__(self, programs, transports, number, name, act):
        self.odd_keys, self.peer = programs
        self.transports, self.number, self.name, self.act = dict(zip(NODES, transports)), number, name, act
        self.wire = self.fleet = self.level = None
        self.failure = None
        self.said = []
        self.running = {}
        self.came = {node: Count() for node in NODES}
        self._change = None

    def run(self):
        try:
            self.wire.change = self.pass_on
            self.fleet = pathlib.Path(self.wire.folder) / "fleet"
            subprocess.run([self.odd_keys, "init", self.fleet, "blue"], check=True)
            for node, transport in self.transports.items():
                subprocess.run([self.odd_keys, "add", self.fleet, node, transport, str(DOMAIN), "0", "365"], check=True)
            self.act(self)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def pass_on(self, node, datagram):
        out = self._change(node, bytearray(datagram)) if self._change else [datagram]
        self.came[node].add()
        return out

    def start(self, level, nodes=NODES):
        """`none` is without keys."""
        self.level = level
        for node in nodes:
            keys = ["-", "encrypt"] if level == "none" else [self.fleet / node, level]
            self.running[node] = self.wire.start(
                node, [self.peer, self.transports[node], node, DOMAIN, *keys, "eth0", LEASE_S])

    def stop(self):
        for process in self.running.values():
            process.kill()

    def both_hear(self, since=0.0):
        for node in NODES:
            self.heard(node, self.wire.other(node), since)

    def heard(self, node, who, since=0.0):
        return self.running[node].wait_for(re.compile(f"heard {who} \\d+").fullmatch, LIMIT_S, since)[0]

    def forged(self):
        return self.running["bravo"].wait_for(re.compile(f"said alpha {FORGED.decode()}").fullmatch, LIMIT_S)

    def change(self, function):
        """What happens to each datagram from now on."""
        self._change = function

    def nothing_heard(self, node, since, why):
        # Cyclone DDS reports participants before it has authenticated them.
        signs = ("heard", "said") + (("appeared",) if self.transports[node] == "fastdds" else ())
        lines = [text for when, text in self.running[node].lines if when >= since and text.startswith(signs)]
        if lines:
            raise AssertionError(f"{node} heard {lines} though {why}")

    def nothing_forged(self):
        lines = [text for process in self.running.values() for _, text in process.lines if text.startswith("said")]
        if lines:
            raise AssertionError(f"forged samples were heard: {lines}")

    def note_lines(self):
        for node, process in self.running.items():
            self.said += [f"{self.transports[node]}: {text}" for _, text in process.lines
                          if text.startswith("log") and not text.endswith("so far)")]


def forge_sample(datagram):
    """The sample in it, with the same number and another content, if one can be told."""
    for each in between.samples(datagram):
        at = bytes(datagram).find(b"alpha", each.at)
        if 0 <= at < each.end:
            datagram[at:at + len(FORGED)] = FORGED
    return datagram


def spoil(datagram):
    """Another byte in the middle of what is protected."""
    if between.is_protected(datagram):
        inner = next((each for each in between.submessages(datagram) if each.kind == 0x30 or each.is_sample()), None)
        if inner:
            datagram[(inner.at + inner.end) // 2] ^= 0x10
    return datagram


def unwrapped(datagram):
    """As it would be without protection: what is signed goes on in plain."""
    if not between.is_protected(datagram):
        return datagram
    plain = [each for each in between.submessages(datagram) if each.kind not in between.SECURE and each.kind != 0x0c]
    return datagram[:between.HEADER] + b"".join(datagram[each.at:each.end] for each in plain)


def without_security(datagram):
    """An announcement of a participant that says nothing of security."""
    for each in between.submessages(datagram):
        if each.kind == between.DATA and each.writer == between.ANNOUNCEMENT:
            found, order = between.parameters(datagram, each)
            for number, at, length in found:
                if number in (0x1001, 0x1002, 0x1005, 0x1006):
                    struct.pack_into(order + "H", datagram, at, 0)
                if number == 0x58 and length == 4:
                    endpoints = struct.unpack_from(order + "I", datagram, at + 4)[0]
                    struct.pack_into(order + "I", datagram, at + 4, endpoints & 0xffff)
    return datagram


def with_other_secret(datagram):
    """A handshake in which the public part of the secret is another one."""
    for name in (b"dh1\0", b"dh2\0"):
        at = bytes(datagram).find(name)
        if at >= 0 and between.has_handshake(datagram) and at + 40 < len(datagram):
            datagram[at + 40] ^= 0x55
    return datagram


def of(name, function):
    return lambda node, datagram: [function(datagram)] if node == name else [datagram]


def altered_samples(case):
    case.start("none")
    case.both_hear()
    case.change(of("alpha", forge_sample))
    case.forged()
    case.stop()
    for level in ("sign", "encrypt"):
        case.change(None)
        case.start(level)
        case.both_hear()
        case.change(of("alpha", lambda datagram: spoil(forge_sample(datagram))))
        since = after_what_was_under_way(case)
        case.came["alpha"].wait_for_more(30)
        case.nothing_heard("bravo", since, "every datagram was altered")
        case.change(None)
        case.heard("bravo", "alpha", since)
        case.nothing_forged()
        case.note_lines()
        case.stop()


def after_what_was_under_way(case):
    """A moment at which bravo has taken what alpha said before the last change."""
    case.came["alpha"].wait_for_more(1)
    case.came["bravo"].wait_for_more(20)
    return time.monotonic()


def replay(case):
    for level in ("none", "sign", "encrypt"):
        first = len(case.wire.recorded["alpha"])
        case.start(level)
        case.both_hear()
        case.running["bravo"].wait_for(re.compile("heard alpha 20").fullmatch, LIMIT_S)
        case.wire.kill("alpha")
        gone, _ = case.running["bravo"].wait_for(re.compile("gone alpha").fullmatch, LIMIT_S)
        recorded = case.wire.recorded["alpha"][first:]
        for _ in range(3):
            case.wire.say_again("alpha", recorded)
            case.came["bravo"].wait_for_more(4)
        if level == "none":
            case.running["bravo"].wait_for(re.compile("appeared alpha").fullmatch, LIMIT_S, gone)
        else:
            case.nothing_heard("bravo", gone, "alpha has ended: that was a replay")
            case.start(level, ["alpha"])
            case.heard("bravo", "alpha", gone)
            case.note_lines()
        case.stop()


def other_secret(case):
    case.change(lambda _, datagram: [with_other_secret(datagram)])
    kept_apart(case, "encrypt", "the secret was another one")


def kept_apart(case, level, why):
    """The change is in place: nobody hears anything for twenty datagrams of each; without it, they do."""
    case.start(level)
    for node in NODES:
        case.running[node].wait_for(re.compile("open").fullmatch, LIMIT_S)
        case.came[node].wait_for_more(20)
    for node in NODES:
        case.nothing_heard(node, 0.0, why)
    case.note_lines()
    case.change(None)
    case.stop()
    # Fast DDS does not retry with a peer that it has refused.
    case.start(level)
    case.both_hear()
    case.stop()


def downgrade(case):
    case.start("none")
    case.both_hear()
    case.stop()
    case.change(lambda _, datagram: [without_security(datagram)])
    kept_apart(case, "encrypt", "the announcements said nothing of security")


def unwrapped_samples(case):
    case.start("sign")
    case.both_hear()
    case.change(of("alpha", unwrapped))
    since = after_what_was_under_way(case)
    case.came["alpha"].wait_for_more(30)
    case.nothing_heard("bravo", since, "samples came without their signatures")
    case.change(None)
    case.heard("bravo", "alpha", since)
    case.note_lines()
    case.stop()


def unkeyed_heartbeat(datagram):
    """A datagram in the name of the sender, without its keys: it has nothing for readers of discovery before 1000."""
    writer = bytes.fromhex("ff0003c2")
    body = bytes(4) + writer + struct.pack("<iIiII", 0, 1000, 0, 999, 1 << 20)
    return bytes(datagram[:between.HEADER]) + struct.pack("<BBH", 0x07, 1, len(body)) + body


def plain_heartbeats(case):
    case.change(lambda node, datagram: [unkeyed_heartbeat(datagram), datagram])
    for level in ("sign", "encrypt"):
        case.start(level)
        case.both_hear()
        case.stop()


CASES = [("altered", altered_samples), ("replayed", replay), ("another secret in the handshake", other_secret),
         ("downgrade of the announcements", downgrade), ("signatures taken off", unwrapped_samples),
         ("heartbeats of discovery without keys", plain_heartbeats)]


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    pairs = [(each, each) for each in transports] + ([tuple(transports[:2])] if len(transports) > 1 else [])
    cases = [Case(programs, pair, number, name, act)
             for number, (name, act, pair) in enumerate((name, act, pair) for name, act in CASES for pair in pairs)]
    with field.skipping():
        with contextlib.ExitStack() as wires:
            for case in cases:
                case.wire = wires.enter_context(between.Wire(NODES, case.number))
            harness.run_at_once(cases)
    for case in cases:
        print(f"{case.name}, {'+'.join(case.transports.values())}: {case.failure or 'to no avail'}")
        for line in sorted(set(case.said)):
            print(f"    {line}")
    failures = [case for case in cases if case.failure]
    print(f"{len(cases)} cases, {len(failures)} failed")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
