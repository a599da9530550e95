#!/usr/bin/env python3
"""A reader that asks for nothing again loses what the network loses, and nothing else: each pair of backends, writers that
are reliable and those that are not.

Usage: gap_test.py NODE TRANSPORT...
Needs to make network namespaces; ends with 77 where it may not."""

import itertools
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import field  # noqa: E402

LIMIT_S = 300  # only keeps a broken test from hanging
LARGE = 1000  # no other datagram on the way is as large
BEFORE = ["a", "b", "c", "d"]
AFTER = ["f", "g"]


def write(writer, line):
    writer.tell(line)
    writer.wait_for(("wrote " + line).__eq__, LIMIT_S)


def send(writer, reader, text):
    write(writer, text)
    reader.wait_for(("got " + text).__eq__, LIMIT_S)


def lose(ground, writer, text):
    """The sample reaches the reader's network, and is dropped there."""
    ground.lose(100, ["writing"], ["reading"])
    before = ground.traffic("reading")[1]
    write(writer, f"{text} {LARGE}")
    field.harness.until(lambda: ground.traffic("reading")[1] >= before + LARGE, LIMIT_S)
    ground.heal()


def run(program, writing, reading, options):
    with field.Field(["writing", "reading"]) as ground:
        reader = ground.start("reading", [program, reading, "read"])
        writer = ground.start("writing", [program, writing, "write", *options])
        writer.wait_for("matched".__eq__, LIMIT_S)
        # The writer knows the reader; the reader may not know the writer yet.
        field.harness.until(lambda: write(writer, "start") or any(text == "got start" for _, text in reader.lines), LIMIT_S)
        for text in BEFORE:
            send(writer, reader, text)
        lose(ground, writer, "e")
        write(writer, AFTER[0])
        send(writer, reader, AFTER[1])
        got = [text.split()[1] for _, text in reader.lines if text.startswith("got ")]
        return [text for text in got if text != "start"]


def main():
    program, transports = sys.argv[1], sys.argv[2:]
    failed = False
    with field.skipping():
        for writing, reading in itertools.product(transports, transports):
            for options in (["--reliable"], []):
                got = run(program, writing, reading, options)
                good = got == BEFORE + AFTER
                print(f"{writing} to {reading} {' '.join(options)}: {' '.join(got)}{'' if good else ' WRONG'}", flush=True)
                failed = failed or not good
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
