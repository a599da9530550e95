#!/usr/bin/env python3
"""The smoke test of whole nodes: real programs over each pair of backends, in namespaces of their own, judged by outcomes
alone. README.md says what is flown.

Usage: smoke.py --ledger-node FILE --rabit FILE --transports NAME[,NAME] --logs FOLDER
Each line that begins with FAILED is one thing that is wrong: pair, flight, what was expected, what was seen.
Exit code 0: all is well; 1: something is wrong; 77: this machine allows no namespaces."""

import argparse
import itertools
import pathlib
import shutil
import signal
import sys
import time
import traceback

import flights
import field
import harness

LIMIT_S = 600  # only ends a broken run


def fly_pair(pair, options):
    """All flights of one pair, one after the other. Returns the exit code."""
    failed = False
    for name in flights.ALL:
        begin = time.monotonic()
        try:
            wrong = flights.fly(name, pair, options)
        except Exception as error:  # the other flights go on  pylint: disable=broad-except
            where = traceback.extract_tb(error.__traceback__)[-1]
            wrong = [f"expected the flight to come to its end; seen: {error!r} in {where.filename}, line {where.lineno}"]
        if not wrong:
            print(f"{'+'.join(pair)}, {name}: well, {time.monotonic() - begin:.1f} s", flush=True)
            continue
        failed = True
        for text in wrong:
            print(f"FAILED {'+'.join(pair)}, {name}: {text}", flush=True)
        print(f"the nodes' ledgers and output: {pathlib.Path(options.logs, '+'.join(pair), name)}", flush=True)
    return 1 if failed else 0


def fly_all(pairs, options):
    """Each pair in a process of its own, all at once. Returns the exit code."""
    children = {}
    try:
        for pair in pairs:
            children[pair] = harness.Process([sys.executable, __file__, *sys.argv[1:], "--pair", ",".join(pair),
                                              "--deadline", time.monotonic() + LIMIT_S])
        codes = {pair: child.exit_code(None) for pair, child in children.items()}
    finally:
        for child in children.values():
            if child.running():
                child.terminate()
    for child in children.values():
        for _, text in child.lines:
            print(text)
    for pair, code in codes.items():
        if code not in (0, 1):
            print(f"FAILED {'+'.join(pair)}, all flights: expected an end of the test; seen: exit code {code}")
    return 1 if any(codes.values()) else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ledger-node", required=True)
    parser.add_argument("--rabit", required=True)
    parser.add_argument("--transports", required=True, help="those that are built")
    parser.add_argument("--logs", required=True, help="the folder for ledgers and output; its old content is removed")
    parser.add_argument("--pair", help="fly this pair alone: NAME,NAME")
    parser.add_argument("--deadline", type=float, default=time.monotonic() + LIMIT_S, help="by the monotonic clock, in s")
    options = parser.parse_args()
    if options.pair:
        return fly_pair(tuple(options.pair.split(",")), options)
    with field.skipping(), field.Field(["probe"]):
        pass
    shutil.rmtree(options.logs, ignore_errors=True)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, field.stop)
    return fly_all(list(itertools.product(options.transports.split(","), repeat=2)), options)


if __name__ == "__main__":
    sys.exit(main())
