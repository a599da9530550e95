#!/usr/bin/env python3
"""Every pair of backends as two processes: mirrors, queue links, presence, samples of 4 MB, and a node that is killed
and comes back. Prints a table with a tick for each thing that worked.

Usage: interop_test.py NODE TRANSPORT...
In each row the first node is started first, and the second is the one that is killed."""

import pathlib
import re
import sys
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
ORDERS = 100

COLUMNS = ["presence", "mirror >", "mirror <", "queue >", "queue <", "4 MB >", "4 MB <", "killed", "return >",
           "return <", "4 MB back", "ended"]


class Row:
    """One pair of nodes in a domain of its own. `nodes`: how each is started, without its options."""

    def __init__(self, nodes, first, second, domain):
        self.nodes, self.transports, self.domain = nodes, (first, second), domain
        self.done = set()
        self.failure = None

    def start(self, processes, index):
        names = ("first", "second")
        process = processes.start([*self.nodes[index], "--node", names[index], "--other", names[1 - index], "--transport",
                                   self.transports[index], "--domain", self.domain, "--interface", "127.0.0.1",
                                   "--count", ORDERS])
        _, ready = process.wait_for(re.compile(r"ready life=(\d+)").fullmatch, LIMIT_S)
        return process, ready.group(1)

    def tick(self, column, process, pattern, since=0.0):
        when, _ = process.wait_for(re.compile(pattern).fullmatch, LIMIT_S, since)
        self.done.add(column)
        return when

    def run(self):
        try:
            with harness.Processes() as processes:
                self.exchange(processes)
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    @staticmethod
    def all_orders(sender, sender_life, receiver, number=1):
        """That all orders of a round came, and that the sender knows."""
        receiver.wait_for(re.compile(f"orders life={sender_life} round={number} count={ORDERS} skipped=0").fullmatch,
                          LIMIT_S)
        sender.wait_for(re.compile(f"settled round={number} delivered={ORDERS} in_doubt=0").fullmatch, LIMIT_S)

    def exchange(self, processes):
        first, first_life = self.start(processes, 0)
        second, second_life = self.start(processes, 1)
        first.wait_for(re.compile("peer UP").fullmatch, LIMIT_S)
        self.tick("presence", second, "peer UP")
        self.tick("mirror >", second, f"mirror life={first_life}")
        self.tick("mirror <", first, f"mirror life={second_life}")
        self.all_orders(first, first_life, second)
        self.done.add("queue >")
        self.all_orders(second, second_life, first)
        self.done.add("queue <")
        self.tick("4 MB >", second, f"frame life={first_life}")
        self.tick("4 MB <", first, f"frame life={second_life}")

        second.kill()
        lost = self.tick("killed", first, "peer LOST")
        again, again_life = self.start(processes, 1)
        first.wait_for(re.compile("peer UP").fullmatch, LIMIT_S, lost)
        again.wait_for(re.compile(f"mirror life={first_life}").fullmatch, LIMIT_S)
        self.all_orders(first, first_life, again, 2)
        self.done.add("return >")
        first.wait_for(re.compile(f"mirror life={again_life}").fullmatch, LIMIT_S)
        self.all_orders(again, again_life, first)
        self.done.add("return <")
        first.wait_for(re.compile(f"frame life={again_life}").fullmatch, LIMIT_S)
        self.tick("4 MB back", again, f"frame life={first_life}")

        for process in (again, first):
            code = process.terminate()
            if code != 0:
                raise AssertionError(f"{process.argv} ended with {code}")
        for process in (first, second, again):
            wrong = [text for _, text in process.lines if re.search("not in order|skipped round|in doubt|garbled|^lost", text)]
            if wrong:
                raise AssertionError(f"{process.argv} said: {wrong[0]}")
        self.done.add("ended")


def print_table(rows):
    head = "first       second      " + " ".join(COLUMNS)
    print(head)
    for row in rows:
        cells = " ".join(("\N{CHECK MARK}" if column in row.done else "-").center(len(column)) for column in COLUMNS)
        print(f"{row.transports[0]:<11} {row.transports[1]:<11} {cells}")


def main():
    node, transports = sys.argv[1], sys.argv[2:]
    harness.enter_namespace()
    pairs = [(first, second) for first in transports for second in transports]
    rows = [Row(([node], [node]), first, second, (harness.domain() + 7 * i) % 200) for i, (first, second) in enumerate(pairs)]
    threads = [threading.Thread(target=row.run) for row in rows]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print_table(rows)
    failures = [f"{row.transports}: {row.failure}" for row in rows if row.failure]
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
