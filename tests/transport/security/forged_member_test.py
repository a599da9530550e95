#!/usr/bin/env python3
"""A thief has taken over uav2, with its keys, in a fleet of uav1 and ground, and sends two sorts of messages:
- signed as a whole with uav2's own key, in which others speak;
- signed as a whole with the key of uav1 or ground, which every member holds, with a sample under the writer's key.
No node obeys them, each counts every kind of them that the guard can tell, and the others' traffic goes on. The signatures are
right: a key is used only if it makes the tags of a datagram that was seen.

Usage: forged_member_test.py RABIT LEDGER_NODE LEAKED_KEYS TRANSPORT...
LEAKED_KEYS: the library that writes down a program's session keys.
Skipped (exit code 77) where no network namespace can be made: the test reads all datagrams on loopback."""

import collections
import pathlib
import re
import socket
import struct
import sys
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402
import loopback  # noqa: E402
import stolen_key_test as base  # noqa: E402
from protected_messages import (HEADER, MESSAGE_POSTFIX, MESSAGE_PREFIX, POSTFIX, PREFIX, TAG, Protection, Signer,  # noqa: E402
                                submessage, submessages)

INFO_SOURCE, DATA, HEARTBEAT, GAP = 0x0c, 0x15, 0x07, 0x08
UNKNOWN = bytes(4)
ANNOUNCER = bytes.fromhex("000100c2")  # the writer of participants' announcements
PARTICIPANT = bytes.fromhex("000001c1")
FORGED = 10 ** 15  # number of a tick
FAR = 1_000_000
TICK_SIZE = 16  # encapsulation, number, and no padding
DROPPED = re.compile(r".*a datagram that is no sound RTPS message was dropped(?: \((\d+) of this kind so far\))?")
KINDS = ("a goodbye of another", "a goodbye of another, without a name", "heartbeat", "gap", "sample", "heartbeat without a name",
         "gap without a name")
# Of messages in the name of their sender: what they are, whether the guard can tell, and their tags of receivers.
IN_ITS_NAME = (("in its name, without a receiver's tag", True, []),
               ("in its name, with the tag of a receiver without a key", True, [(bytes(4), bytes(TAG))]),
               ("in its name, with the thief's own tag", False, None))
RECORD = 1 + 32  # of a key: whether it encrypts (e), and the key
KEPT = 32  # datagrams of each participant
SAME_FORGERY_TIMES = 4  # what is repeated three times might be believed


def number(value):
    return struct.pack("<iI", value >> 32, value & 0xffffffff)


def source(prefix):
    return submessage(INFO_SOURCE, bytes(4) + b"\x02\x03\x01\x0f" + prefix)


def heartbeat(writer, first, last):
    return submessage(HEARTBEAT, UNKNOWN + writer + number(first) + number(last) + struct.pack("<I", FAR))


def gap(writer, first, end):
    return submessage(GAP, UNKNOWN + writer + number(first) + number(end) + bytes(4))


def goodbye(prefix):
    guid = prefix + PARTICIPANT
    status = struct.pack("<HH", 0x71, 4) + b"\0\0\0\3" + struct.pack("<HH", 0x70, 16) + guid + struct.pack("<HH", 1, 0)
    key = b"\0\3\0\0" + struct.pack("<HH", 0x50, 16) + guid + struct.pack("<HH", 1, 0)
    return submessage(DATA, b"\0\0\x10\0" + UNKNOWN + ANNOUNCER + number(FAR) + status + key, flags=1 | 2 | 8)


def last_number(data):
    high, low = struct.unpack_from(data.order + "iI", data.whole, 16)
    return (high << 32) + low


def sample(data, sequence):
    """A sample as this writer sends them, with that number; a tick with the forged one."""
    out = bytearray(data.whole)
    struct.pack_into(data.order + "iI", out, 16, sequence >> 32, sequence & 0xffffffff)
    struct.pack_into("<Q", out, len(out) - TICK_SIZE + 4, FORGED)
    return bytes(out)


def ticks_in_its_name(datagram, keys):
    """(what it is, whether the guard can tell, a message of the sender of `datagram` with a forged tick); none, if the keys of the
    message or of its tick are not among these."""
    parts = list(submessages(datagram))
    signer = Signer(datagram, keys)
    for (at, prefix), (_, data), (_, postfix) in zip(parts, parts[1:], parts[2:]):
        if ([each.kind for each in (prefix, data, postfix)] != [PREFIX, DATA, POSTFIX] or len(data.whole) != 24 + TICK_SIZE
                or not signer.is_known()):
            continue
        writer = Protection(prefix.whole, data.whole, postfix.whole, keys)
        if not writer.is_known():
            continue
        for count, (kind, is_told, tags) in enumerate(IN_ITS_NAME):
            tick = writer.around(sample(data, last_number(data) + 1), count)
            yield kind, is_told, signer.message(datagram[parts[1][0]:at] + tick + datagram[postfix.end:parts[-1][0]], tags)


class Seen:
    """The signed datagrams of one domain: the last ones of each participant, its writers, and who receives."""

    def __init__(self, domain):
        self._ports = range(7400 + 250 * domain, 7400 + 250 * (domain + 1))
        self._lock = threading.Lock()
        self._last = collections.defaultdict(lambda: collections.deque(maxlen=KEPT))
        self._writers, self._to = collections.defaultdict(dict), set()

    def on_datagram(self, _, destination, datagram):
        if destination not in self._ports or datagram[:4] != b"RTPS" or datagram[HEADER] != MESSAGE_PREFIX:
            return
        prefix = bytes(datagram[8:HEADER])
        parts = list(submessages(datagram))
        if parts[-1][1].kind != MESSAGE_POSTFIX or len(parts[-1][1].whole) < 4 + TAG + 4:
            return
        with self._lock:
            self._last[prefix].append(bytes(datagram))
            self._to.add(destination)
            for _, each in parts:
                if each.kind == DATA:
                    self._writers[prefix][each.whole[12:16]] = each

    def datagrams(self, prefix):
        with self._lock:
            return list(self._last[prefix])

    def signer_of_all(self, keys):
        """Signs as the participant whose keys these are, for at least two receivers; None: there is no such datagram yet."""
        with self._lock:
            datagrams = [datagram for last in self._last.values() for datagram in last]
        signers = (Signer(datagram, keys) for datagram in datagrams)
        return next((signer for signer in signers if signer.is_known() and signer.receivers() > 1), None)

    def others(self, own):
        """(prefix, {writer: its last sample}) of each."""
        with self._lock:
            return [(prefix, dict(writers)) for prefix, writers in self._writers.items() if prefix != own]

    def receivers(self):
        with self._lock:
            return sorted(self._to)


def forgeries(own, victim, writers):
    """(what it is, the body of a message of `own`, in which `victim` speaks)"""
    yield "a goodbye of another", source(victim) + goodbye(victim)
    yield "a goodbye of another, without a name", source(own) + goodbye(victim)
    for writer, data in writers.items():
        last = last_number(data)
        for name in (source(victim), source(own) + source(victim)):
            yield "heartbeat", name + heartbeat(writer, last + FAR, last + 2 * FAR)
            yield "gap", name + gap(writer, 1, last + 1000)
            if len(data.whole) >= 24 + TICK_SIZE:
                yield "sample", name + sample(data, last + 1)
        yield "heartbeat without a name", heartbeat(writer, last + FAR, last + 2 * FAR)
        yield "gap without a name", gap(writer, 1, last + 1000)


def leaked(file):
    """The session keys of the thief: those with which it signs, and all."""
    keys = file.read_bytes() if file.exists() else b""
    records = [keys[i:i + RECORD] for i in range(0, len(keys) - RECORD + 1, RECORD)]
    return {record[1:] for record in records if record[:1] == b"e"}, {record[1:] for record in records}


class Takeover(base.Case):
    def __init__(self, programs, library, domain, transports):
        super().__init__(programs, domain, transports, forge, True)
        self.library = library
        self.seen = Seen(domain)


def counted(node):
    """How many datagrams a node says that it has dropped. It says so of the 1st, the 2nd, the 4th, the 8th ..."""
    found = [DROPPED.fullmatch(line) for line in node.said()]
    return max((int(match.group(1) or 1) for match in found if match), default=0)


def forge_until_counted(case, nodes, kind, send):
    """Sends one kind of forgery, and nothing else, until the count of each node has doubled."""
    before = {node: counted(node) for node in nodes}
    sent = 0

    def are_counted():
        nonlocal sent
        if all(counted(node) > before[node] for node in nodes):
            return True
        sent += len(send())
        return False

    harness.until(are_counted, base.LIMIT_S)
    for node in nodes:
        case.note(node, f"{kind}: {sent} datagrams were sent to all; {node.name} had dropped {before[node]}, and now "
                        f"at least {counted(node)}")


def in_anothers_name(case, nodes, out, victims, keys):
    """Sends ticks in the name of each victim: of each kind, until all nodes have counted it."""
    def send(kind):
        fitting = keys()
        made = [message for victim in victims for datagram in case.seen.datagrams(victim)
                for each, _, message in ticks_in_its_name(datagram, fitting) if each == kind]
        for message in made:
            for port in case.seen.receivers():
                out.sendto(message, ("127.0.0.1", port))
        return made
    for kind, is_told, _ in IN_ITS_NAME:
        if is_told:
            forge_until_counted(case, nodes, kind, lambda kind=kind: send(kind))
        else:
            assert harness.until(lambda kind=kind: send(kind), base.LIMIT_S)


def forge(case):
    """signs messages in which others speak;"""
    endless = ["--sign", "--ticks", "--count", 1000000, "--rate", 20]
    uav1 = case.node("uav1", "--accept-from", "ground", "--to", "ground", *endless)
    ground = case.node("ground", "--to", "uav1", *endless)
    file = case.folder / "leaked"
    thief = base.Node(case, "uav2", case.transports["uav2"], "--keys", case.folder / "keys" / "uav2", "--sign", "--ticks",
                      env={"LD_PRELOAD": case.library, "LEAKED_KEYS": str(file)})
    base.meet(uav1, ground, thief)
    for node in (uav1, ground):
        node.wait_for("tick from=uav2 .*", 5)
    # A session key of the thief is for 32 messages, so the last datagrams are from two sessions at most.
    signer = harness.until(lambda: case.seen.signer_of_all(leaked(file)[0]), base.LIMIT_S)
    # Both have sent ticks by now.
    others = harness.until(lambda: [each for each in case.seen.others(signer.prefix) if each[1]], base.LIMIT_S)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    in_anothers_name(case, (uav1, ground), out, [prefix for prefix, _ in others], lambda: leaked(file)[1])
    kinds = collections.defaultdict(list)
    for victim, writers in others:
        for kind, body in forgeries(signer.prefix, victim, writers):
            kinds[kind].append(body)
    missing = set(KINDS) - set(kinds)
    assert not missing, f"nothing was made of these kinds: {missing}"
    for kind, bodies in kinds.items():
        forge_until_counted(case, (uav1, ground), kind, lambda bodies=bodies: [
            out.sendto(signer.message(body), ("127.0.0.1", port))
            for body in bodies for _ in range(SAME_FORGERY_TIMES) for port in case.seen.receivers()])
    base.goes_on(uav1, ground)
    for node, other in ((uav1, "ground"), (ground, "uav1")):
        ticks = f"tick from={other} .*"
        node.wait_for(ticks, len(node.find(ticks)) + 10)
    # The thief's own node takes what has the thief's own tag.
    for node in (uav1, ground):
        base.never(node, f"tick .*number={FORGED}.*")


def main():
    programs, library, transports = sys.argv[1:3], sys.argv[3], sys.argv[4:]
    harness.enter_namespace_or_skip()
    cases = [Takeover(programs, library, number, {"uav1": transports[0], "ground": transports[-1], "uav2": thief})
             for number, thief in enumerate(transports)]

    def on_datagram(*what):
        for case in cases:
            case.seen.on_datagram(*what)
    loopback.Watch(on_datagram)
    harness.run_at_once(cases)
    for case in cases:
        print(f"{case} {case.failure or 'as it should be'}")
        for line in case.noted:
            print(f"    {line}")
    sys.exit(1 if any(case.failure for case in cases) else 0)


if __name__ == "__main__":
    main()
