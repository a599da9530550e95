#!/usr/bin/env python3
"""Somebody who has taken over uav2, with its keys, in a fleet of uav1 and ground: messages that are signed as a whole with
uav2's own key, and in which others speak. No node obeys them, each counts every kind of them, and the others' traffic goes on. The
signatures are right: first one of uav2's own datagrams is made once more, and is the same.

Usage: forged_member_test.py RABIT LEDGER_NODE LEAKED_KEYS TRANSPORT...
LEAKED_KEYS: the library that writes down a program's session keys.
Skipped (exit code 77) where no network namespace can be made: the test reads all datagrams on loopback."""

import collections
import ctypes
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
import loopback  # noqa: E402
import stolen_key_test as base  # noqa: E402

SKIPPED = 77
HEADER, CRYPTO, TAG = 20, 20, 16
MESSAGE_PREFIX, MESSAGE_POSTFIX, INFO_SOURCE = 0x33, 0x34, 0x0c
DATA, HEARTBEAT, GAP = 0x15, 0x07, 0x08
UNKNOWN = bytes(4)
ANNOUNCER = bytes.fromhex("000100c2")  # the writer of participants' announcements
PARTICIPANT = bytes.fromhex("000001c1")
FORGED = 10 ** 15  # number of a tick
FAR = 1_000_000
TICK_SIZE = 16  # encapsulation, number, and no padding
DROPPED = re.compile(r".*a datagram that is no sound RTPS message was dropped(?: \((\d+) of this kind so far\))?")
KINDS = ("a goodbye of another", "a goodbye of another, without a name", "heartbeat", "gap", "sample", "heartbeat without a name",
         "gap without a name")
SAME_FORGERY_TIMES = 4  # what is repeated three times might be believed


class Submessage:
    def __init__(self, datagram, at):
        self.kind, self.flags = datagram[at], datagram[at + 1]
        self.order = "<" if self.flags & 1 else ">"
        length = struct.unpack_from(self.order + "H", datagram, at + 2)[0]
        self.end = at + 4 + length if length or self.kind in (1, 9) else len(datagram)
        self.whole = bytes(datagram[at:self.end])


def submessages(datagram, at=HEADER):
    while at + 4 <= len(datagram):
        each = Submessage(datagram, at)
        yield at, each
        at = each.end


def submessage(kind, body, flags=1):
    return struct.pack("<BBH", kind, flags, len(body)) + body


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


def sample(data, sequence):
    """A sample as this writer sends them, with that number; a tick with the forged one."""
    out = bytearray(data.whole)
    struct.pack_into(data.order + "iI", out, 16, sequence >> 32, sequence & 0xffffffff)
    struct.pack_into("<Q", out, len(out) - TICK_SIZE + 4, FORGED)
    return bytes(out)


class Crypto:
    """AES-256 in Galois counter mode, over text that is signed and not encrypted."""

    _library = ctypes.CDLL("libcrypto.so.3")
    for _name in ("EVP_CIPHER_CTX_new", "EVP_aes_256_gcm"):
        getattr(_library, _name).restype = ctypes.c_void_p

    @classmethod
    def tag(cls, key, iv, text):
        library, size, tag = cls._library, ctypes.c_int(), ctypes.create_string_buffer(TAG)
        context = ctypes.c_void_p(library.EVP_CIPHER_CTX_new())
        get_tag = 0x10
        done = (library.EVP_EncryptInit_ex(context, ctypes.c_void_p(library.EVP_aes_256_gcm()), None, key, iv) == 1
                and library.EVP_EncryptUpdate(context, None, ctypes.byref(size), text, len(text)) == 1
                and library.EVP_EncryptFinal_ex(context, tag, ctypes.byref(size)) == 1
                and library.EVP_CIPHER_CTX_ctrl(context, get_tag, TAG, tag) == 1)
        library.EVP_CIPHER_CTX_free(context)
        assert done
        return tag.raw


class Signer:
    """Signs messages as the participant that has sent `datagram`, with one of its keys."""

    def __init__(self, datagram, keys):
        self.prefix = bytes(datagram[8:HEADER])
        self._header = bytes(datagram[:HEADER + 4 + CRYPTO - 8])
        self._count = 0
        parts = list(submessages(datagram))
        begin, end = HEADER + 4 + CRYPTO, parts[-1][0]
        self._postfix = bytes(datagram[end:end + 4])
        fitting = [key for key in keys
                   if self._signed(key, bytes(datagram[begin - 8:begin]), bytes(datagram[begin:end])) == datagram]
        self._key = fitting[0] if fitting else None

    def is_known(self):
        return self._key is not None

    def _signed(self, key, iv_suffix, body):
        head = self._header + iv_suffix
        return head + body + self._postfix + Crypto.tag(key, head[-12:], body) + bytes(4)

    def message(self, body):
        self._count += 1
        return self._signed(self._key, struct.pack(">II", 0xffff0000, self._count), body)


class Seen:
    """The signed datagrams of one domain: the last one of each participant, its writers, and who receives."""

    def __init__(self, domain):
        self._ports = range(7400 + 250 * domain, 7400 + 250 * (domain + 1))
        self._lock = threading.Lock()
        self._last, self._writers, self._to = {}, collections.defaultdict(dict), set()

    def on_datagram(self, _, destination, datagram):
        if destination not in self._ports or datagram[:4] != b"RTPS" or datagram[HEADER] != MESSAGE_PREFIX:
            return
        prefix = bytes(datagram[8:HEADER])
        parts = list(submessages(datagram))
        if parts[-1][1].kind != MESSAGE_POSTFIX or len(parts[-1][1].whole) != 4 + TAG + 4:
            return
        with self._lock:
            self._last[prefix] = datagram
            self._to.add(destination)
            for _, each in parts:
                if each.kind == DATA:
                    self._writers[prefix][each.whole[12:16]] = each

    def signers(self, keys):
        with self._lock:
            datagrams = list(self._last.values())
        return [signer for signer in (Signer(datagram, keys) for datagram in datagrams) if signer.is_known()]

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
        high, low = struct.unpack_from(data.order + "iI", data.whole, 16)
        last = (high << 32) + low
        for name in (source(victim), source(own) + source(victim)):
            yield "heartbeat", name + heartbeat(writer, last + FAR, last + 2 * FAR)
            yield "gap", name + gap(writer, 1, last + 1000)
            if len(data.whole) >= 24 + TICK_SIZE:
                yield "sample", name + sample(data, last + 1)
        yield "heartbeat without a name", heartbeat(writer, last + FAR, last + 2 * FAR)
        yield "gap without a name", gap(writer, 1, last + 1000)


def leaked(file):
    keys = file.read_bytes() if file.exists() else b""
    return {keys[i:i + 32] for i in range(0, len(keys) - 31, 32)}


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
    sent, end = 0, time.monotonic() + base.LIMIT_S
    while any(counted(node) <= before[node] for node in nodes):
        assert time.monotonic() < end, f"{kind}: sent {sent} datagrams, but {[(node.name, counted(node)) for node in nodes]}"
        sent += len(send())
        time.sleep(0.1)
    for node in nodes:
        case.note(node, f"{kind}: {sent} datagrams were sent to all; {node.name} had dropped {before[node]}, and now "
                        f"at least {counted(node)}")


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
    (signer,) = harness.until(lambda: case.seen.signers(leaked(file)), base.LIMIT_S)
    # Both have sent ticks by now.
    others = harness.until(lambda: [each for each in case.seen.others(signer.prefix) if each[1]], base.LIMIT_S)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
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
    for node in (uav1, ground, thief):
        base.never(node, f"tick .*number={FORGED}.*")


def main():
    programs, library, transports = sys.argv[1:3], sys.argv[3], sys.argv[4:]
    harness.enter_namespace()
    if os.environ[harness.IN_NAMESPACE] != "yes":
        sys.exit(SKIPPED)
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
