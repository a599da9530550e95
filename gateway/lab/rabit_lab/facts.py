"""Follows what the nodes record, by the program lab_facts (facts/FlightFile.h). It hears nothing and sends nothing: on the air
it does not exist."""

import json
import queue

from rabit_lab import processes

LAST_ROUND_S = 60


class Facts:
    """`wall_clock`: seconds from the lab's clock to the machine's wall clock."""

    def __init__(self, program, folder, fields, nodes, flight, wall_clock):
        self._nodes, self._flight, self._wall_clock = nodes, flight, wall_clock
        self._waiting = queue.SimpleQueue()
        self._lives = {}  # file -> index of its life
        argv = [program, str(folder)]
        for field in fields:
            argv += ["--fields", field]
        self._process = processes.Process(argv, on_line=self._waiting.put)

    def take(self, on_fields):
        """Takes what has come. `on_fields(node, message, value, time)` gets positions."""
        while True:
            try:
                fact = json.loads(self._waiting.get_nowait())
            except queue.Empty:
                return
            except ValueError:
                continue
            index = self._life_of(fact["file"]) if "file" in fact else None
            if index is None:
                continue
            offset = self._wall_clock + self._flight.lives[index].clock_step

            def to_lab(nanoseconds, offset=offset):
                return nanoseconds / 1e9 - offset
            if fact["fact"] == "fields":
                on_fields(self._flight.lives[index].node, fact["message"], fact["value"], to_lab(fact["t"]))
            else:
                self._flight.take(fact, index, to_lab)

    def _life_of(self, path):
        if path not in self._lives:
            self._lives[path] = self._nodes.life_of(path)
        return self._lives[path]

    def finish(self, on_fields):
        """A last round, after the nodes have ended."""
        self._process.close_input()
        self._process.exit_code(LAST_ROUND_S)
        self.take(on_fields)
