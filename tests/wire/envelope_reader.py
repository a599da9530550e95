#!/usr/bin/env python3
"""Reads and makes sealed datagrams, written from transport/envelope/README.md alone: it shares no code with the program.

Usage: envelope_reader.py VECTORS [MADE]
Opens the datagrams in VECTORS (lines of a name and hexadecimal digits), and compares. Then writes into MADE datagrams of its own
for the same receiver. Needs python3-cryptography."""

import hashlib
import pathlib
import struct
import sys

from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.asymmetric.x25519 import X25519PrivateKey, X25519PublicKey
from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305
from cryptography.hazmat.primitives.kdf.hkdf import HKDF
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

GROUP, PAIRWISE, CLAIM = 0, 2, 3
TRAFFIC, MEETING, BULLETIN = range(3)
NO_SESSION, NO_HEADER = bytes(16), bytes(20)


def hkdf(salt, secret, info):
    return HKDF(algorithm=hashes.SHA256(), length=32, salt=salt, info=info).derive(secret)


def public(private):
    return private.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw)


def nonce(number):
    return bytes(4) + struct.pack("<Q", number)


class Node:
    """A node as others know it: from its certificate, its session, and its RTPS headers."""

    def __init__(self, certificate, session, headers):
        self.certificate, self.session, self.headers = certificate, session, headers
        self.hash = hashlib.sha256(certificate).digest()
        self.tag = hashlib.sha256(b"Rabit session 1" + session + self.hash).digest()[:4]
        self.signing, self.agreement = certificate[14:46], certificate[46:78]

    def is_certified(self, authority):
        Ed25519PublicKey.from_public_bytes(authority).verify(
            self.certificate[-64:], b"Rabit certificate 1" + self.certificate[:-64])
        return True


def key_of(kind, secret, epoch, sender, receiver, private):
    """private: the X25519 key of either end, for the pairwise kind alone."""
    if kind != PAIRWISE:
        return hkdf(sender.session, secret, b"Rabit group 1" + epoch + sender.hash)
    other = receiver if public(private) == sender.agreement else sender
    shared = private.exchange(X25519PublicKey.from_public_bytes(other.agreement))
    return hkdf(secret, shared, b"Rabit pairwise 1" + epoch + sender.session + receiver.session + sender.hash + receiver.hash)


def context_of(outer, number, sender, kind, receiver):
    to = receiver.session if kind == PAIRWISE else NO_SESSION
    left = NO_HEADER if kind == CLAIM else sender.headers[outer[0] & 3]
    return b"Rabit envelope 1" + outer + struct.pack("<I", number >> 32) + sender.session + sender.hash + to + left


def open_datagram(datagram, high, secret, sender, receiver, private):
    """Returns the RTPS message, or the plaintext of a claim. high: the high half of the number, if it is no claim."""
    outer = datagram[:11]
    assert outer[0] >> 6 == 2 and outer[3:7] == sender.tag
    kind = outer[0] >> 4 & 3
    rest = datagram[11:]
    if kind == CLAIM:
        assert rest[:48] == sender.session + sender.hash
        high, rest = struct.unpack("<I", rest[48:52])[0], rest[52:]
    number = high << 32 | struct.unpack("<I", outer[7:])[0]
    context = context_of(outer, number, sender, kind, receiver)
    key = key_of(kind, secret, outer[1:3], sender, receiver, private)
    plain = ChaCha20Poly1305(key).decrypt(nonce(number), rest, context)
    if kind != PAIRWISE:
        plain, signature = plain[:-64], plain[-64:]
        Ed25519PublicKey.from_public_bytes(sender.signing).verify(signature, context + plain)
    return plain if kind == CLAIM else context[-20:] + plain


def seal_datagram(plain, kind, contents, header, number, epoch, secret, sender, receiver, signing, private):
    """plain: an RTPS message without its header, or a claim."""
    outer = bytes([0x80 | kind << 4 | contents << 2 | header]) + epoch + sender.tag + struct.pack("<I", number & 0xffffffff)
    context = context_of(outer, number, sender, kind, receiver)
    if kind != PAIRWISE:
        plain += signing.sign(context + plain)
    introduction = sender.session + sender.hash + struct.pack("<I", number >> 32) if kind == CLAIM else b""
    key = key_of(kind, secret, epoch, sender, receiver, private)
    return outer + introduction + ChaCha20Poly1305(key).encrypt(nonce(number), plain, context)


def claim_of(sender, answers):
    return (bytes([1, len(sender.headers), len(answers)]) + bytes(8) + b"".join(sender.headers) + b"".join(answers) +
            bytes([len(sender.certificate)]) + sender.certificate)


def secret_of_bulletin(bulletin, authority, serial, private):
    Ed25519PublicKey.from_public_bytes(authority).verify(bulletin[-64:], b"Rabit bulletin 1" + bulletin[:-64])
    epoch, once, revoked, nodes = bulletin[1:3], bulletin[3:35], *struct.unpack("<HH", bulletin[35:39])
    entries = bulletin[39 + 4 * revoked:-64]
    entry = next(entries[52 * i:52 * i + 52] for i in range(nodes) if entries[52 * i:52 * i + 4] == serial)
    shared = private.exchange(X25519PublicKey.from_public_bytes(once))
    key = hkdf(once + public(private), shared, b"Rabit bulletin 1" + epoch + serial)
    return ChaCha20Poly1305(key).decrypt(bytes(12), entry[4:], epoch + serial)


def main():
    vectors = {name: bytes.fromhex(digits) for name, digits in
               (line.split(" ") for line in pathlib.Path(sys.argv[1]).read_text().splitlines())}
    a, b = (Node(vectors[f"{who}_certificate"], vectors[f"{who}_session"], [vectors[f"{who}_header0"], vectors[f"{who}_header1"]])
            for who in "ab")
    secret, epoch, authority = vectors["secret"], vectors["epoch"], vectors["authority"]
    private = X25519PrivateKey.from_private_bytes(vectors["b_agreement"])
    assert a.is_certified(authority) and b.is_certified(authority)
    plain = open_datagram(vectors["claim"], 0, secret, a, b, private)
    assert plain == plain[:3] + plain[3:11] + claim_of(a, [vectors["b_nonce"]])[11:]
    pairs = [("group", "message"), ("pairwise", "message"), ("group_of_second_header", "message_of_second_header")]
    for name, message in pairs:
        assert open_datagram(vectors[name], 5, secret, a, b, private) == vectors[message], name
    assert secret_of_bulletin(vectors["bulletin"], authority, bytes([2, 0, 0, 0]), private) == vectors["next_secret"]
    print(f"{len(pairs) + 2} opened")
    if len(sys.argv) > 2:
        signing = Ed25519PrivateKey.from_private_bytes(vectors["a_signing"])
        own = X25519PrivateKey.from_private_bytes(vectors["a_agreement"])

        def sealed(plain, kind, contents, header, number):
            return seal_datagram(plain, kind, contents, header, (7 << 32) - 2 + number, epoch, secret, a, b, signing, own)
        vectors["claim"] = sealed(claim_of(a, [vectors["b_nonce"]]), CLAIM, MEETING, 0, 0)
        for number, (name, kind, contents, header) in enumerate((("group", GROUP, TRAFFIC, 0),
                                                                 ("pairwise", PAIRWISE, MEETING, 0)), start=1):
            vectors[name] = sealed(vectors["message"][20:], kind, contents, header, number)
        vectors["group_of_second_header"] = sealed(vectors["message_of_second_header"][20:], GROUP, BULLETIN, 1, 3)
        pathlib.Path(sys.argv[2]).write_text("".join(f"{name} {content.hex()}\n" for name, content in vectors.items()))


if __name__ == "__main__":
    main()
