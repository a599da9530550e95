"""Runs a scenario from its beginning to the folder of its results."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import threading
import time

from rabit_lab import facts as fact_reader
from rabit_lab import expectations, faults, flight as flights, junit, network, nodes, places, processes, report, table, timeline

TICK_S = 0.05
COUNT_EACH_S = 1.0
PLACES_EACH_S = 0.5
SETTLE_S = 1.0  # a node that ends in this time has not started


class Runner:
    """One run. It must be in a cage, which cleans up."""

    def __init__(self, scenario, folder, tools, spaces=None, keys=None):
        self.scenario, self.folder, self.tools = scenario, pathlib.Path(folder), tools
        self.flight = flights.Flight(scenario)
        self._began = None
        self._spaces = spaces or network.Spaces()
        self._keys = keys
        self._interrupted = threading.Event()
        self._table = table.Table(scenario, self.flight)
        self._observer = None
        self._failed_start = False
        self._nets = self._nodes = self._facts = self._faults = None
        self._places = {}

    def now(self):
        return time.monotonic() - self._began if self._began is not None else 0.0

    def say(self, text):
        self._table.say(self.now(), text)

    def run(self):
        """Returns the verdicts."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: self._interrupted.set())
        shutil.copy(self.scenario.path, self.folder / "scenario.yaml")
        nets = network.Networks(self.scenario, self.tools.radio, self.folder, self._spaces)
        self._nodes = nodes.Nodes(self.scenario, nets, self.flight, self.folder, self.tools, self.now, self._keys)
        self._places = {name: places.Places(one, self.scenario.folder)
                        for name, one in self.scenario.networks.items() if one.range}
        self._nets = nets
        pauses = processes.Pauses()
        self._began = time.monotonic()
        fields = sorted({place.message for place in self._places.values() if place.message})
        self._facts = fact_reader.Facts(self.tools.facts, self.folder / "records", fields, self._nodes, self.flight,
                                        time.time())
        self._faults = faults.Faults(self.scenario, nets, self._nodes, self.flight, self._places, self.say)
        for node in self.scenario.nodes.values():
            if node.start == 0:
                self._nodes.start(node.name)
        self.say(f"{sum(bool(self.flight.lives_of(name)) for name in self.scenario.fleet())} nodes started")
        interrupted = not self._fly()
        self._end(pauses)
        verdicts = [] if interrupted else [expect.verdict(self.flight) for expect in self._expects()]
        self._write(verdicts, interrupted)
        return None if interrupted else verdicts

    def _expects(self):
        stays = expectations.Stays("no node ends by itself", 0)
        return [stays] if self._failed_start else [stays, *self.scenario.expects]

    def _fly(self):
        """Until the end of the run; False if it was interrupted."""
        next_count = next_place = 0.0
        while self.now() < self.scenario.run:
            now = self.now()
            self._faults.run_due(now)
            for life in self._nodes.look():
                self.say(f"{life.node} ended by itself with {life.code}: {' | '.join(life.last_lines[-3:])}")
                if life.ended - life.began < SETTLE_S and life.number == 1 and life.code != 0:
                    self._failed_start = True
                    return True
            self._facts.take(self._on_fields)
            if self.scenario.observe and self._observer is None and self.flight.about:
                domain = next(iter(self.flight.about.values()))["domain"]
                self._observer = self._nodes.start_observer(domain)
            if now >= next_count:
                next_count = now + COUNT_EACH_S
                self._count()
            if now >= next_place:
                next_place = now + PLACES_EACH_S
                self._place(now)
            self._table.show(now)
            if self._interrupted.wait(TICK_S):
                return False
        return True

    def _on_fields(self, node, message, value, _):
        for place in self._places.values():
            if place.message == message:
                place.take(node, value)

    def _count(self):
        for name, channel in self._nets.radios.items():
            self.flight.radio[name].append((self.now(), channel.tell("counters")))

    def _place(self, now):
        for name, place in self._places.items():
            for one, other, percent, burst in place.changes(now):
                if not self._faults.rules_loss(self.scenario.networks[name], one, other):
                    self._nets.radios[name].tell(f"loss {percent:.2f} burst {burst:g} {one} {other}")
            for one, other, percent in place.high():
                self.flight.distant.append((now, one, other, percent))
            for node, position in place.positions(now).items():
                self.flight.positions[node].append((now, position))

    def _end(self, pauses):
        self.flight.end = self.now()
        while self._faults.waits() and not self._interrupted.is_set():
            time.sleep(TICK_S)
        self.say("the nodes are told to end")
        self._nodes.stop(list(self.scenario.nodes), "end")
        if self._observer and self._observer.running():
            self._observer.signal(signal.SIGINT)
            try:
                self._observer.exit_code(10)
            except subprocess.TimeoutExpired:
                self._observer.kill()
        self._facts.finish(self._on_fields)
        self._count()
        for name, channel in self._nets.radios.items():
            self.flight.lateness[name] = channel.tell("lateness")
            self.flight.census[name] = channel.tell("kinds")
            channel.kill()
        self._spaces.end()
        self.flight.pauses = [(a - self._began, b - self._began) for a, b in pauses.end()]
        self._note()

    def _note(self):
        for begin, end in self.flight.pauses:
            self.flight.notes.append(f"the machine stood still for {end - begin:.1f} s at {begin:.1f} s")
        for name, late in self.flight.lateness.items():
            if late["unwritten"] or late["most_us"] > 20000:
                self.flight.notes.append(f"{name}: the emulated channel was late, by {late['most_us'] / 1000:.1f} ms at most; "
                                         f"{late['unwritten']} frames did not fit into a node's device")
        for node, lives in ((node, self.flight.lives_of(node)) for node in self.scenario.nodes):
            if lives and not self.scenario.nodes[node].plain and not any(life.recorded for life in lives):
                self.flight.notes.append(f"{node} wrote no recording, so nothing is known of what it saw: its program takes "
                                         "no RABIT_NODE_RECORD (Rabit::RunNode does)")
        for place in self._places.values():
            for node in sorted(place.refused):
                self.flight.notes.append(f"range: {place.message} of {node} has no members that are a position; name "
                                         "them with `fields`")

    def _write(self, verdicts, interrupted):
        merged = self._merge()
        (self.folder / "radio.json").write_text(json.dumps(
            {name: {"counters": counts[-1][1], "kinds": self.flight.census.get(name), "lateness": self.flight.lateness.get(name)}
             for name, counts in self.flight.radio.items()}, indent=1), encoding="utf-8")
        (self.folder / "verdicts.txt").write_text("".join(
            "\t".join(("met" if verdict.good else "not met", verdict.text, verdict.detail)).replace("\n", " ") + "\n"
            for verdict in verdicts), encoding="utf-8")
        timeline.write(self.flight, self.folder / "log.txt")
        junit.write(self.scenario, verdicts, self.flight, interrupted, self.folder / "junit.xml")
        report.write(self.scenario, self.flight, verdicts, interrupted, merged, self.folder)
        for name in ("clocks", "disks"):
            shutil.rmtree(self.folder / name, ignore_errors=True)
        owner = os.stat(self.folder)
        if os.geteuid() == 0 and owner.st_uid != 0:
            subprocess.run(["chown", "-R", f"{owner.st_uid}:{owner.st_gid}", str(self.folder)], check=False)

    def _merge(self):
        """One recording of all nodes, on one time line; or why there is none."""
        files = sorted(str(path) for path in (self.folder / "records").rglob("*.mcap"))
        if not files:
            return "no node wrote a recording"
        done = subprocess.run([self.tools.rabit, "merge", str(self.folder / "flight.mcap"), *files, "--wall-clock"],
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if (self.folder / "flight.mcap").exists():
            return ""
        return f"rabit merge: {done.stdout.strip().splitlines()[-1] if done.stdout.strip() else 'failed'}"
