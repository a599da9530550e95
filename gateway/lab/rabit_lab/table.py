"""What a person sees while a scenario runs."""

import shutil
import sys

from rabit_lab import network as networks

EACH_S = 1.0
PLAIN_EACH_S = 10.0
MOST_ROWS = 24


def safe(text):
    """Without characters that control a terminal: nodes and the network choose some of the text."""
    return "".join(c if c.isprintable() else "?" for c in str(text))


class Table:
    """On a terminal a table that is written over itself, and events above it; elsewhere a line each ten seconds."""

    def __init__(self, scenario, flight, out=None):
        self._scenario, self._flight = scenario, flight
        self._out = out or sys.stdout
        self._live = self._out.isatty()
        self._next = 0.0
        self._height = 0

    def say(self, now, text):
        """A line that stays."""
        self._clear()
        self._out.write(f"{now:7.1f} s  {safe(text)}\n")
        self._out.flush()

    def _clear(self):
        if self._height:
            self._out.write(f"\x1b[{self._height}F\x1b[J")
            self._height = 0

    def show(self, now):
        if now < self._next:
            return
        self._next = now + (EACH_S if self._live else PLAIN_EACH_S)
        width = shutil.get_terminal_size().columns
        lines = [safe(line)[:width] for line in self.lines(now)] if self._live else [f"{now:7.1f} s  {self.summary(now)}"]
        self._clear()
        self._out.write("".join(line + "\n" for line in lines))
        self._out.flush()
        self._height = len(lines) if self._live else 0

    def seen(self, node, now):
        """{state: number of other nodes that have it so}"""
        counts = {}
        for index, life in self._flight.observers(node):
            peer = self._flight.peers[index, node].at(now) if life.is_there(now) else None
            if peer:
                counts[peer.state] = counts.get(peer.state, 0) + 1
        return counts

    def summary(self, now):
        fleet = self._scenario.fleet()
        there = sum(self._flight.life_at(node, now) is not None for node in fleet)
        # A node that is cut off has lost all others: they are not LOST for that.
        lost, few = [], 0
        for node in fleet:
            counts = self.seen(node, now)
            if 2 * counts.get("LOST", 0) > sum(counts.values()):
                lost.append(node)
            elif counts.get("LOST"):
                few += 1
        return (f"{there} of {len(fleet)} nodes run" + (f"; LOST: {', '.join(lost)}" if lost else "")
                + (f"; {few} more at half of the others or fewer" if few and lost
                   else f"; {few} LOST at half of the others or fewer" if few else "") + self._channels())

    def _channels(self):
        text = ""
        for name, counts in self._flight.radio.items():
            if len(counts) > 1 and name != networks.OBSERVER:
                (begin, first), (end, last) = counts[-2:]
                rate = 8 * (last["sent"]["bytes"] - first["sent"]["bytes"]) / max(end - begin, 1e-9)
                used = f", {100 * (last['busy_s'] - first['busy_s']) / max(end - begin, 1e-9):.0f} % used" \
                    if last["bits_per_s"] else ""
                text += f"; {name} {rate / 1000:.0f} kbit/s{used}"
        return text

    def lines(self, now):
        rows = [("NODE", "RUNS", "OTHERS SEE IT", "SENDS", "OLDEST VALUE", "PROBLEMS")]
        for node in list(self._scenario.nodes)[:MOST_ROWS]:
            rows.append(self._row(node, now))
        widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
        more = len(self._scenario.nodes) - MOST_ROWS
        return lines + ([f"... and {more} more"] if more > 0 else []) + [f"{now:.0f} of {self._scenario.run:g} s"
                                                                        + self._channels()]

    def _row(self, node, now):
        life = self._flight.life_at(node, now)
        number = len(self._flight.lives_of(node))
        frozen = any(began <= now < ended for began, ended in self._flight.frozen(node))
        runs = ("frozen" if frozen else "yes" if number == 1 else f"incarnation {number}") if life else "no" if number else "-"
        seen = " ".join(f"{state} {count}" for state, count in sorted(self.seen(node, now).items(), reverse=True))
        air = self._flight.air.get(node)
        sends = f"{air[-1][1]:.0f} B/s" if life and air else "-"
        oldest = self._oldest(node, life, now) if life else "-"
        problems = [problem for problem in self._flight.problems if problem[0] == node and problem[5] is None] if life else []
        return node, runs, seen or "-", sends, oldest, f"{len(problems)}: {problems[-1][1]}" if problems else "-"

    def _oldest(self, node, life, now):
        index = self._flight.lives.index(life)
        ages = [(now - posted, f"{origin}/{message}") for (origin, message), posted in self._flight.newest[index].items()
                if origin != node]
        return "{1} {0:.1f} s".format(*max(ages)) if ages else "-"
