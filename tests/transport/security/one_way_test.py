#!/usr/bin/env python3
"""Nodes with keys, one of which hears nothing of the other one until it shows it LOST. Once the way is open they meet again, and
all that was sent meanwhile is delivered. What happens is that of ../../gate/flights.py.

Usage: one_way_test.py RABIT LEDGER_NODE TRANSPORT...
Skipped (exit code 77) where no network namespaces can be made."""

import pathlib
import sys
import time
import types

TESTS = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "gate"), str(TESTS / "integration")]
import flights  # noqa: E402
import field  # noqa: E402
import fleet_keys  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300


def fly(rabit, ledger_node, pair):
    """Returns what is wrong."""
    with field.Field(flights.NODES) as ground:
        keys = fleet_keys.make(rabit, ground.folder, flights.NODES)
        options = types.SimpleNamespace(ledger_node=ledger_node, deadline=time.monotonic() + LIMIT_S)
        flight = flights.Flight(options, ground, dict(zip(flights.NODES, pair)), keys=keys)
        try:
            flights.one_way(flight)
            return flight.end()
        except flights.Failure as failure:
            return [str(failure)]


def main():
    programs, transports = sys.argv[1:3], sys.argv[3:]
    failed = False
    with field.skipping():
        for pair in ((first, second) for first in transports for second in transports):
            wrong = fly(*programs, pair)
            print(f"{'+'.join(pair)}: {wrong or 'met again'}", flush=True)
            failed = failed or bool(wrong)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
