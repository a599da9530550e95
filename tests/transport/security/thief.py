"""Somebody with the keys of a member, who seals datagrams by itself: with ../../wire/envelope_reader.py, which shares no code with
the program. It proves to the other members that it is live, reads what they send to several, and speaks in another's name."""

import base64
import contextlib
import itertools
import os
import pathlib
import re
import struct
import sys
import threading
import types

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "wire"))
import envelope_reader as envelope  # noqa: E402
import loopback  # noqa: E402
from cryptography.exceptions import InvalidSignature, InvalidTag  # noqa: E402
from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305  # noqa: E402
from cryptography.hazmat.primitives.serialization import (Encoding, PublicFormat, load_pem_private_key,  # noqa: E402
                                                          load_pem_public_key)

BLOCK = re.compile(rb"-----BEGIN ([A-Z ]+)-----\n(.*?)-----END \1-----\n", re.DOTALL)
INFO_SOURCE, DATA = 0x0c, 0x15
UNKNOWN = bytes(4)  # a reader
ANNOUNCER = bytes.fromhex("000100c2")  # the writer of participants' announcements
PARTICIPANT = bytes.fromhex("000001c1")
HEADER, SIGNATURE, INTRODUCTION = 20, 64, 52
TICK = 24 + 16  # DATA with encapsulation, number and no padding
FORGED = 10 ** 15  # number of a tick
FAR = 1_000_000  # ahead of all numbers


def pem_blocks(file):
    return [match.group(0) for match in BLOCK.finditer(file.read_bytes())]


def content_of(block):
    return base64.b64decode(BLOCK.match(block).group(2))


def submessage(kind, body, flags=1):
    return struct.pack("<BBH", kind, flags, len(body)) + body


def submessages(message):
    """(kind, byte order, bytes) of each (OMG DDSI-RTPS 2.3, 8.3.3.2)."""
    at = HEADER
    while at + 4 <= len(message):
        order = "<" if message[at + 1] & 1 else ">"
        length = struct.unpack_from(order + "H", message, at + 2)[0]
        end = at + 4 + length if length or message[at] in (1, 9) else len(message)
        yield message[at], order, message[at:end]
        at = end


def source(prefix):
    return submessage(INFO_SOURCE, bytes(4) + b"\x02\x03\x01\x0f" + prefix)


def goodbye(prefix):
    """The end of that participant."""
    guid = prefix + PARTICIPANT
    status = struct.pack("<HH", 0x71, 4) + b"\0\0\0\3" + struct.pack("<HH", 0x70, 16) + guid + struct.pack("<HH", 1, 0)
    key = b"\0\3\0\0" + struct.pack("<HH", 0x50, 16) + guid + struct.pack("<HH", 1, 0)
    return submessage(DATA, b"\0\0\x10\0" + UNKNOWN + ANNOUNCER + struct.pack("<iI", 0, FAR) + status + key, flags=1 | 2 | 8)


def forged_tick(order, data):
    """A later sample of that writer."""
    out = bytearray(data)
    high, low = struct.unpack_from(order + "iI", out, 16)
    struct.pack_into(order + "iI", out, 16, high, low + 1)
    struct.pack_into("<Q", out, len(out) - 12, FORGED)
    return bytes(out)


class Session(envelope.Node):
    """A session of a member, with what was heard of it."""

    def __init__(self, certificate, session, headers):
        super().__init__(certificate, session, headers)
        self.name = certificate[111:111 + certificate[110]].decode()
        self.number = 0  # the newest one
        self.ticks = {}  # writer -> (byte order, its newest one)


class Thief:
    """`keys`: the folder of a member. Give `seen` each datagram of the domain, from before the members start."""

    def __init__(self, keys, domain):
        signing, agreement = pem_blocks(keys / "key")
        self._signing, self._agreement = (load_pem_private_key(each, None) for each in (signing, agreement))
        certificate = content_of(pem_blocks(keys / "certificate")[0])
        authority = load_pem_public_key((keys / "authority").read_bytes()).public_bytes(Encoding.Raw, PublicFormat.Raw)
        bulletin = content_of(pem_blocks(keys / "bulletin")[-1])
        self._secret = envelope.secret_of_bulletin(bulletin, authority, certificate[2:6], self._agreement)
        self._epoch = bulletin[1:3]
        self._numbers = itertools.count()  # of all its sessions: each needs rising ones
        self._other = None  # a session that claims another one's headers
        self._me = Session(certificate, os.urandom(16), [b"RTPS\x02\x03\x01\x0f" + os.urandom(12)])
        self._group = ("239.255.0.1", 7400 + 250 * domain)
        self._mouth = loopback.mouth()
        self._lock = threading.Lock()
        self._sessions = {}  # tag -> Session
        self.answered = set()  # names of members that asked whether it is live

    def _send(self, plain, kind, contents, sender, number):
        self._mouth.sendto(envelope.seal_datagram(plain, kind, contents, 0, number, self._epoch, self._secret, sender, None,
                                                  self._signing, None), self._group)

    def introduce(self, answers=()):
        """Its own session. Members answer by asking whether it is live."""
        with self._lock:
            self._send(envelope.claim_of(self._me, list(answers)), envelope.CLAIM, envelope.MEETING, self._me, next(self._numbers))

    def seen(self, datagram):
        if len(datagram) < 11 + INTRODUCTION or datagram[0] >> 6 != 2 or datagram[3:7] == self._me.tag:
            return
        with contextlib.suppress(InvalidTag, InvalidSignature):  # of another epoch, or forged here
            if datagram[0] >> 4 & 3 == envelope.CLAIM:
                self._hear_claim(datagram)
            elif datagram[0] >> 4 & 3 == envelope.GROUP:
                self._hear(datagram)

    def _hear_claim(self, datagram):
        number = struct.unpack_from("<I", datagram, 59)[0] << 32 | struct.unpack_from("<I", datagram, 7)[0]
        sender = types.SimpleNamespace(session=datagram[11:27], hash=datagram[27:59])
        context = envelope.context_of(datagram[:11], number, sender, envelope.CLAIM, None)
        key = envelope.key_of(envelope.CLAIM, self._secret, self._epoch, sender, None, None)
        plain = ChaCha20Poly1305(key).decrypt(envelope.nonce(number), datagram[11 + INTRODUCTION:], context)[:-SIGNATURE]
        headers, answers, asks = plain[1], plain[2], plain[3:11]
        certificate = plain[11 + HEADER * headers + 8 * answers + 1:]
        tag = datagram[3:7]
        with self._lock:
            if tag not in self._sessions and certificate:
                self._sessions[tag] = Session(certificate, sender.session,
                                              [plain[11 + HEADER * i:31 + HEADER * i] for i in range(headers)])
            known = self._sessions.get(tag)
        if any(asks):
            self.introduce([asks])
            self.answered |= {known.name} if known else set()

    def _hear(self, datagram):
        with self._lock:
            sender = self._sessions.get(datagram[3:7])
        if sender is None or datagram[0] & 3 >= len(sender.headers):
            return
        message = envelope.open_datagram(datagram, 0, self._secret, sender, None, None)
        sender.number = struct.unpack_from("<I", datagram, 7)[0]
        for kind, order, data in submessages(message):
            if kind == DATA and len(data) == TICK and data[15] & 0xc0 != 0xc0:
                sender.ticks[data[12:16]] = order, data

    def of(self, name):
        """The session of that member that was heard first; None: none was."""
        with self._lock:
            return next((each for each in self._sessions.values() if each.name == name), None)

    def speak_as(self, victim):
        """Ticks and the goodbye of another session, once in each way."""
        prefix = victim.headers[0][8:]
        bodies = [goodbye(prefix), *(forged_tick(*tick) for tick in list(victim.ticks.values()))]
        with self._lock:
            # In its own session: the other one is named as the source, or only inside.
            for body in (each for body in bodies for each in (source(prefix) + body, body)):
                self._send(body, envelope.GROUP, envelope.TRAFFIC, self._me, next(self._numbers))
            # In a session of its own that claims the other one's headers.
            self._other = self._other or Session(self._me.certificate, os.urandom(16), victim.headers)
            self._send(envelope.claim_of(self._other, []), envelope.CLAIM, envelope.MEETING, self._other, next(self._numbers))
            for body in bodies:
                self._send(body, envelope.GROUP, envelope.TRAFFIC, self._other, next(self._numbers))
            # In the other one's session.
            for number, body in enumerate(bodies, victim.number + FAR):
                self._send(body, envelope.GROUP, envelope.TRAFFIC, victim, number)
