#!/usr/bin/env python3
"""Where the instructions of a message of 100 B go: both nodes of a ping under callgrind, by parts of the program.

Usage: profile.py FOLDER_OF_PROGRAMS TRANSPORT [CARRIAGE]"""

import collections
import re
import subprocess
import sys
import tempfile

from contestants import NODE, Contestants, harness, result

# As in instructions.py: the difference excludes start and end.
FEW, MORE = 200, 1700
LIMIT_S = 200
# The first that matches a function, which callgrind names with its library, counts.
PARTS = [
    ("the vendor", r"\[.*(libddsc|libfastrtps)"),
    ("malloc, free, operator new", r"malloc|_int_free|calloc|unlink_chunk|operator (new|delete)|\bfree\b.*\[.*libc"),
    ("locks and wake-ups", r"(mutex|cond|futex|rwlock|lll_).*\[.*libc"),
    ("memcpy, memcmp", r"mem(cpy|cmp|move|set).*\[.*libc"),
    ("the guard", r"Rabit::Rtps::"),
    ("the backend", r"Rabit::(Cyclone|FastDds)::|Rejoining|Vendor|WriteAndTell|WriteOne|ReadAndTell|HeldDatagrams"
                    r"|SessionLog|HandlerGate|HardwareAddresses"),
    ("encode, decode", r"Idl::|Bench::Sample|fastcdr"),
    ("the links", r"Link(Sender|Receiver|Peer|Node|Outbox|Frame|Context)|Path(Control|Timers)|RoundTrip|ReorderBuffer"
                  r"|Outcome|Assembly|IsWellFormed|RingBuffer"),
    ("the queues", r"Link(Driver|Datagrams|Sample|Payload)|(Incoming|Outgoing|Accepted|Remote)Queue|AcceptanceOf"
                   r"|OpenLinkSample|Refusal|::Split"),
    ("the rest of the gateway", r"Gateway|AirTraffic|Presence|PeerTable|Capacity|AirBudget|Delay|Topic|Foreign"
                                r"|Exploration|BeatPace|Type(Answers|Questions)|StateRepair"),
    ("core", r"Rabit::(Rabit|Manager|HangWatch|UptimeClock)|SystemTimeClock|SystemRabitClock|PublishSubscribe|Workspace"),
]


def part_of(function):
    return next((name for name, pattern in PARTS if re.search(pattern, function)), "other")


def functions(file):
    text = subprocess.run(["callgrind_annotate", "--threshold=100", file], check=True, text=True,
                          capture_output=True).stdout
    for count, name in re.findall(r"^ *([\d,]+) \([^)]*\) +(\S.*)$", text, re.MULTILINE):
        if "PROGRAM TOTALS" not in name:
            yield name, int(count.replace(",", ""))


def of_a_run(programs, transport, carriage, count, folder):
    """Instructions by part."""
    options = {"carriage": carriage, "payload": 100, "warm-up": 100, "count": count}

    def start(processes, role):
        return processes.start(["valgrind", "--tool=callgrind", "--fair-sched=try",
                                f"--callgrind-out-file={folder}/{role}", *programs.argv(NODE, transport, role, options)])
    with harness.Processes() as processes:
        server, client = start(processes, "pong"), start(processes, "ping")
        result(client, limit_s=LIMIT_S)
        client.exit_code(LIMIT_S)
        server.terminate(LIMIT_S)
    parts = collections.Counter()
    for role in ("ping", "pong"):
        for name, instructions in functions(f"{folder}/{role}"):
            parts[part_of(name)] += instructions
    return parts


def main():
    folder, transport, *carriage = sys.argv[1:]
    harness.enter_namespace()
    programs = Contestants(folder, harness.domain())
    with tempfile.TemporaryDirectory() as out:
        few, more = (of_a_run(programs, transport, (carriage or ["queue"])[0], count, out) for count in (FEW, MORE))
    message = {name: (more[name] - few[name]) / (MORE - FEW) / 2 for name in more}
    total = sum(message.values())
    print(f"| part | {transport} | % |\n|---|---|---|")
    for name, instructions in sorted(message.items(), key=lambda item: -item[1]):
        print(f"| {name} | {instructions:.0f} | {100 * instructions / total:.0f} |")
    print(f"| all | {total:.0f} | |")


if __name__ == "__main__":
    main()
