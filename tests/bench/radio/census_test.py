#!/usr/bin/env python3
"""The census of frames that are made up."""

import struct

import census

HEADER = b"RTPS" + bytes(16)
DESTINATION = struct.pack("<BBH", 0x0e, 1, 12) + bytes(12)


def frame(message, last_byte=2, multicast=False, protocol=17, fragment=0):
    size = 28 + len(message)
    address = bytes([239, 255, 0, 1]) if multicast else bytes([10, 0, 0, last_byte])
    packet = struct.pack(">BBHHHBBH4s4s", 0x45, 0, size, 1, fragment, 64, protocol, 0, bytes(4), address)
    return bytes(12) + b"\x08\x00" + packet + bytes(8) + message + bytes(6)  # padded by Ethernet


def submessage(kind, writer, size=24, little=True):
    order = "<" if little else ">"
    at = 8 if kind in census.SAMPLES else 4
    return struct.pack(order + "BBH", kind, int(little), size) + bytes(at) + struct.pack(">I", writer) + bytes(size - at - 4)


def what_is_said_is_told_by_its_writer():
    for writer, whose in ((0x000100c2, "SPDP"), (0x000003c2, "SEDP writers"), (0x00000103, "user"),
                          (0x000300c3, "builtin 000300c3")):
        assert census.contents(HEADER + submessage(0x15, writer)) == f"{whose} DATA"
        assert census.contents(HEADER + DESTINATION + submessage(0x06, writer, little=False)) == f"{whose} ACKNACK"


def several_in_one_are_all_told():
    message = HEADER + submessage(0x15, 0x103) + submessage(0x07, 0x103, 28)
    assert census.contents(message) == "user DATA, user HEARTBEAT"


def bytes_are_those_of_ip_without_padding():
    assert census.kind_of(frame(HEADER + submessage(0x15, 0x103))) == ("one", "user DATA", 28 + 20 + 28)
    assert census.kind_of(frame(HEADER + submessage(0x15, 0x103), multicast=True))[0] == "all"


def what_is_no_rtps_is_told():
    assert census.kind_of(frame(b"beep"))[1] == "not RTPS"
    assert census.kind_of(frame(b"beep", protocol=1))[1] == "not UDP"
    assert census.kind_of(frame(b"beep", fragment=185))[1] == "the rest of a datagram that IP cut"
    assert census.kind_of(bytes(12) + b"\x08\x06" + bytes(30)) is None


def any_bytes_are_read():
    message = HEADER + submessage(0x15, 0x103) + submessage(0x07, 0x103, 28)
    for size in range(len(message)):
        census.kind_of(frame(message[:size]))


def stretches_count_what_is_in_them():
    data = frame(HEADER + submessage(0x15, 0x103))
    lines = census.table([(0.5, data), (1.5, data), (1.9, data), (3.0, data)], [1, 2]).splitlines()
    assert lines[0] == "0 to 1 s: 0.1 kB, 0.08 kB/s", lines
    assert lines[2] == "1 to 2 s: 0.2 kB, 0.15 kB/s", lines
    assert "2 x    76 B  to one  user DATA" in lines[3], lines


def main():
    for test in (what_is_said_is_told_by_its_writer, several_in_one_are_all_told,
                 bytes_are_those_of_ip_without_padding, what_is_no_rtps_is_told, any_bytes_are_read,
                 stretches_count_what_is_in_them):
        test()
        print(f"ok: {test.__name__}")


if __name__ == "__main__":
    main()
