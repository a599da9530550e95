#!/usr/bin/env python3
"""Writes the seeds of a target into a folder: the recorded bytes of tests/wire, captured datagrams, and the texts of this
repository.

Usage: seeds.py TARGET FOLDER"""

import json
import pathlib
import re
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LARGEST_TEXT = 8000


def recorded(test):
    """The bytes in a test of tests/wire: string literals of hexadecimal digits alone, joined with their neighbours."""
    text = (ROOT / "tests" / "wire" / test).read_text(encoding="ascii")
    for literals in re.findall(r'(?:"[0-9a-f]+(?:\\n)?"\s*)+', text):
        digits = "".join(re.findall(r"[0-9a-f]+", literals.replace("\\n", " ")))
        if len(digits) >= 8 and len(digits) % 2 == 0:
            yield bytes.fromhex(digits)


def part(data):
    return struct.pack("<H", len(data)) + data


def captured():
    """Datagrams."""
    for line in (HERE / "seeds" / "datagrams.hex").read_text(encoding="ascii").splitlines():
        if not line.startswith("#"):
            yield bytes.fromhex(line)


def order(datagram):
    """Announcements of participants first, then those of endpoints: others count only behind them."""
    return 0 if b"\x00\x01\x00\xc2" in datagram else 1 if re.search(rb"\x00\x00[\x03\x04]\xc2", datagram) else 2


def guard():
    """Each datagram, and all in a row, a second apart, from their host and from another, in each mode of ../guard.cpp."""
    header = b"RTPS\2\3\1\x0f" + bytes(range(12))
    # NACK_FRAG for fragment 1 of sample 1 of a writer.
    yield b"\0\0" + part(header + b"\x12\1\x20\0" + b"\0\0\1\4\0\0\1\3" + struct.pack("<iIIIII", 0, 1, 1, 1, 0, 1))
    datagrams = sorted(captured(), key=order)
    for mode in range(2):
        for data in datagrams:
            yield bytes([mode, 0]) + part(data)
        for how in (b"\1", b"\x19"):
            yield bytes([mode | 4]) + b"".join(how + part(data) for data in datagrams)
            yield bytes([mode]) + b"".join(how + part(data) for data in datagrams)


def cards():
    for data in recorded("CardBytesTest.cpp"):
        yield data
        yield b"\1" + part(data)
    yield b"".join(b"\1" + part(data) for data in recorded("CardBytesTest.cpp"))


def beats():
    yield from recorded("PresenceBytesTest.cpp")


def links():
    yield from recorded("LinkBytesTest.cpp")


def mcap():
    yield from recorded("RecordingBytesTest.cpp")


def backfill():
    """Stamps, a span, and posts, from a time in 2026."""
    first = struct.pack("<Q", 1790000000000000000 >> 10 << 1)
    for data in (b"\1\xe8\x07\xc0\x84\x3d", b"\7\x80\x80\x01\x05", b"\x05\3abc\xe8\x07\0\1\2xy"):
        yield first + part(data)


def idl():
    """Each file with each of its structs."""
    for file in sorted([*(ROOT / "idl" / "messages").glob("*.idl"), *(ROOT / "tests" / "idl" / "messages").glob("*.idl")]):
        text = file.read_text(encoding="utf-8")
        module = re.search(r"module (\w+)", text)
        if len(text) <= LARGEST_TEXT:
            for name in re.findall(r"struct (\w+)", text)[:4]:
                yield f"{module[1] + '::' if module else ''}{name}\n{text}".encode()


EVERY = {
    "id": 1, "yes": True, "letter": "a", "byte": 255, "tiny": -128, "little": 1, "us": 65535, "ul": 4294967295,
    "large": "-9223372036854775808", "ull": 18446744073709551615, "real": 1.5, "precise": "NaN", "text": "\u00e9", "texts": ["a"],
    "colour": "BLUE", "flags": ["FIRST", "LAST"], "nested": [{"bytes": "AAAA", "more": "", "word": "w"}] * 2,
    "inners": [{}], "choice": {"inner": {"word": "w"}}, "choices": [{"number": 2}, {"_d": 9, "colour": "RED"}],
    "grid": [[1, 2, 3], [4, 5, 6]]}


def json_values():
    yield b"{}"
    yield json.dumps(EVERY).encode()
    for name, value in EVERY.items():
        yield json.dumps({name: value}).encode()
    yield b'{"text": {"base64": "/w=="}}'


def cdr():
    for choice in range(4):
        yield bytes([choice, 0, 1, 0, 0]) + bytes(400)
        yield bytes([choice, 0, 0, 0, 0]) + bytes(64)
    for data in recorded("PresenceBytesTest.cpp"):
        yield b"\1" + data


def yaml():
    for file in sorted([*(ROOT / "examples").glob("**/*.yaml"), *(ROOT / "tests" / "consumer").glob("**/*.yaml")]):
        yield file.read_bytes()
    for readme in sorted((ROOT / "gateway").glob("**/*.md")):
        for text in re.findall(r"```(?:yaml)?\n(node:.*?)```", readme.read_text(encoding="utf-8"), re.S):
            yield text.encode()


def page():
    for target in ("/", "/live?token=abc", "/pictures/uav1"):
        for more in ("", "Cookie: rabit=abc\r\n", "Authorization: Bearer abc\r\n",
                     "Origin: http://127.0.0.1:8080\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"):
            yield f"\0GET {target} HTTP/1.1\r\nHost: 127.0.0.1:8080\r\n{more}\r\n".encode()
    yield b'\1{"type": "clock", "page_s": 1.5}'
    place = '"latitude_deg": 47.4, "longitude_deg": 8.5'
    yield f'\1{{"type": "order", "ref": 1, "kind": "goto", "node": "uav1", {place}, "altitude_m": 510, "speed_mps": 12}}'.encode()
    yield b'\1{"type": "order", "ref": 1, "kind": "home", "node": "uav1"}'
    yield (f'\1{{"type": "area", "ref": 2, {place}, "north_m": 400, "east_m": 600, "altitude_m": 510, "speed_mps": 16, '
           '"lane_m": 60}').encode()
    yield b'\2{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 2}]}'
    yield b'\2{"op": "unsubscribe", "subscriptionIds": [1]}'


def mavlink_sum(data):
    """CRC-16/MCRF4XX."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0x8408 if value & 1 else 0)
    return struct.pack("<H", value)


def mavlink():
    def frame(number, extra, payload):
        body = struct.pack("<BBBBBBHB", len(payload), 0, 0, 7, 1, 1, number & 0xFFFF, number >> 16) + payload
        return b"\xfd" + body + mavlink_sum(body + bytes([extra]))

    frames = [frame(0, 50, bytes(range(1, 10))), frame(30, 39, bytes(range(1, 29))), frame(33, 104, bytes(range(1, 29)))]
    for each in frames:
        yield part(each)
    yield part(b"".join(frames)) + part(frames[0][:5]) + part(frames[0][5:])


SEEDS = {"guard": guard, "cards": cards, "beats": beats, "announcements": beats, "links": links, "backfill": backfill,
         "mcap": mcap, "idl": idl, "json": json_values, "cdr": cdr, "yaml": yaml, "page": page, "mavlink": mavlink}


def write(target, folder):
    for number, data in enumerate(SEEDS[target]()):
        (folder / f"{number:03}").write_bytes(data)


if __name__ == "__main__":
    write(sys.argv[1], pathlib.Path(sys.argv[2]))
