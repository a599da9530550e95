"""The processes of the fleet: start, end, and their output on the lab's time line."""

import functools
import os
import pathlib
import signal
import struct
import subprocess

from rabit_lab import cage, flight as flights, network as networks, processes

STOP_S = 10  # for a node to end on SIGTERM
KILL_S = 5  # for the kernel to end it
DISK_BYTES = 4 << 30  # nominal; it takes memory only for what is in it
LAST_LINES = 20


class Nodes:
    """Starts and ends the nodes, in their namespaces. `now` is the lab's clock, `keys` what keys.make returns."""

    def __init__(self, scenario, nets, flight, folder, tools, now, keys=None):
        self._scenario, self._nets, self._flight = scenario, nets, flight
        self._folder, self._tools, self.now = pathlib.Path(folder), tools, now
        self._keys = keys or {}  # name -> folder
        self._running = {}  # node -> (life index, Process)
        self._steps = {}  # node -> seconds
        self._logs = {}
        self._stepped = {node for event in scenario.events if event.verb == "clock" for node in event.values["nodes"]}
        self._mounted = set()
        for event in scenario.events:
            if event.verb == "disk":
                for node in event.values["nodes"]:
                    self._mount(node)

    def disk(self, node):
        """The folder `{disk}` of a node."""
        path = self._folder / "disks" / node
        path.mkdir(parents=True, exist_ok=True)
        return path

    def _mount(self, node):
        if node not in self._mounted:
            cage.mount("tmpfs", str(self.disk(node)), "tmpfs", 0, f"size={DISK_BYTES}")
            self._mounted.add(node)

    def fill(self, node, full):
        """Makes the disk full, or empty again: its size is what is in it now."""
        state = os.statvfs(self.disk(node))
        used = (state.f_blocks - state.f_bfree) * state.f_frsize
        size = max(used, state.f_frsize) if full else DISK_BYTES
        cage.mount("tmpfs", str(self.disk(node)), "tmpfs", 32, f"size={size}")  # MS_REMOUNT

    def step_clock(self, node, seconds):
        self._steps[node] = self._steps.get(node, 0) + seconds
        self._write_clock(node)

    def _clock(self, node):
        return self._folder / "clocks" / node

    def _write_clock(self, node):
        self._clock(node).parent.mkdir(exist_ok=True)
        file = os.open(self._clock(node), os.O_WRONLY | os.O_CREAT, 0o644)
        os.pwrite(file, struct.pack("=q", self._steps.get(node, 0)), 0)
        os.close(file)

    def start(self, name):
        """Starts a new life of a node that does not run. The first life also starts the programs beside the node."""
        if self.is_running(name):
            return
        node, place = self._scenario.nodes[name], self._scenario.place_of(name)
        number = len(self._flight.lives_of(name)) + 1
        life = flights.Life(name, number, self.now(), self._steps.get(name, 0))
        records = self.records(name, number)
        records.mkdir(parents=True)
        if node.image:  # its user is seldom the lab's
            for folder in (records, self.disk(name)):
                folder.chmod(0o777)
        env = {"RABIT_NODE_RECORD": str(records), "RABIT_NODE_INTERFACE": ",".join(self._nets.addresses(place)),
               "RABIT_LAB_DISK": str(self.disk(name)), **self._keys_of(name, "RABIT_NODE_KEYS"), **node.env}
        if name in self._stepped:
            self._write_clock(name)
            env.update({"LD_PRELOAD": self._tools.stepped_clock, "STEPPED_CLOCK": str(self._clock(name))})
        self._flight.lives.append(life)
        index = len(self._flight.lives) - 1
        known = {"{disk}": str(self.disk(name)), "{address}": self._nets.addresses(place)[0], "{incarnation}": str(number)}
        argv = [functools.reduce(lambda text, key: text.replace(key, known[key]), known, word) for word in node.command]
        argv, env = self._nets.spaces.start(place, argv, env)
        process = processes.Process(argv, env, on_line=lambda text: self._line(index, text),
                                    cwd=self.disk(name) if node.beside else self._scenario.folder, start_new_session=True)
        self._running[name] = (index, process)
        if number == 1:
            for other in self._scenario.nodes.values():
                if other.beside == name and not self._flight.lives_of(other.name):
                    self.start(other.name)

    def _keys_of(self, name, variable):
        return {variable: str(self._keys[name])} if name in self._keys else {}

    def records(self, name, number):
        return self._folder / "records" / name / str(number)

    def life_of(self, path):
        """The index of the life that a recording belongs to, by its place; none for other files."""
        parts = pathlib.Path(path).relative_to(self._folder).parts
        if len(parts) < 3:
            return None
        lives = [index for index, life in enumerate(self._flight.lives) if life.node == parts[1]]
        if parts[0] == "records" and parts[2].isdigit() and 1 <= int(parts[2]) <= len(lives):
            return lives[int(parts[2]) - 1]
        return None

    def _line(self, index, text):
        time, life = self.now(), self._flight.lives[index]
        self._flight.output.append((time, life.node, text))
        life.last_lines = [*life.last_lines[1 - LAST_LINES:], text]
        log = self._logs.get(life.node)
        if log is None:
            (self._folder / "logs").mkdir(exist_ok=True)
            # pylint: disable=consider-using-with
            log = self._logs[life.node] = open(self._folder / "logs" / f"{life.node}.log", "w", encoding="utf-8")
        log.write(f"{time:9.3f} {text}\n")
        log.flush()

    def is_running(self, name):
        return name in self._running and self._running[name][1].running()

    def look(self):
        """Notices the nodes that have ended by themselves; returns their lives."""
        found = []
        for name, (index, process) in list(self._running.items()):
            if not process.running():
                self._ended(name, "itself", process.exit_code(5))
                found.append(self._flight.lives[index])
        return found

    def _ended(self, name, by, code):
        index, _ = self._running.pop(name)
        self._nets.spaces.ended(name)
        life = self._flight.lives[index]
        life.ended, life.by, life.code = self.now(), by, code

    def signal(self, name, number):
        """To the node and its children."""
        if self.is_running(name):
            self._nets.spaces.signal(name, self._running[name][1], number)

    def kill(self, name):
        if self.is_running(name):
            self._ended(name, "kill", self._kill(name))

    def _kill(self, name):
        """The exit code, once the node and its children have closed their output and so their sockets."""
        process = self._running[name][1]
        self.signal(name, signal.SIGKILL)
        try:
            return process.exit_code(KILL_S)
        except subprocess.TimeoutExpired:
            return process.kill()

    def stop(self, names, by="stop"):
        """SIGTERM to all of them at once; their exit codes."""
        running = [name for name in names if self.is_running(name)]
        for name in running:
            self.signal(name, signal.SIGCONT)
            self.signal(name, signal.SIGTERM)
        end = self.now() + STOP_S
        for name in running:
            process = self._running[name][1]
            try:
                code = process.exit_code(max(end - self.now(), 0.1))
            except subprocess.TimeoutExpired:
                self._kill(name)
                code = None
            self._ended(name, by, code)

    def start_tool(self, host, argv, on_line, name):
        """The program `rabit`, in the place of a node. `name`: that of its keys, if there are any."""
        environment = {"RABIT_INTERFACE": ",".join(self._nets.addresses(host)), **self._keys_of(name, "RABIT_KEYS")}
        return processes.Process(self._nets.spaces.inside(host, [self._tools.rabit, *argv]), environment, on_line=on_line,
                                 start_new_session=True)

    def start_observer(self, domain):
        """Records all messages as one observer on the air hears them."""
        return self.start_tool(networks.OBSERVER, ["record", "--to", str(self._folder / "observer"), "--domain", str(domain)],
                               lambda text: None, networks.OBSERVER)
