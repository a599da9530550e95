"""The same as field.py, with each node in a container, by way of docker/fleet.sh."""

import pathlib
import shutil
import tempfile

import docker_engine

CONSOLE = docker_engine.ROOT / "docker" / "fleet.sh"


class Container:
    """A node as harness.Process shows it, as far as the tests need it."""

    def __init__(self, ground, node):
        self._ground = ground
        self._node = node

    @property
    def lines(self):
        return [(0.0, text) for text in self._ground.console("logs", self._node).splitlines()]

    def running(self):
        return self._ground.is_running(self._node)

    def kill(self):
        self._ground.console("kill", self._node)

    def terminate(self):
        return int(self._ground.console("stop", self._node))


class DockerField:
    """with DockerField(engine, ["ground", "uav1"]) as field: field.start("uav1", ["ledger_node", ...])"""

    def __init__(self, engine, nodes):
        self.nodes = list(nodes)
        self.folder = None
        self.processes = {}
        self._engine = engine
        self._faulty = set()

    def __enter__(self):
        # The nodes run as another user and write here.
        self.folder = tempfile.mkdtemp(prefix=self._engine.mark + "-")
        pathlib.Path(self.folder).chmod(0o777)
        self._engine.environment.update(
            FLEET=self._engine.mark, IMAGE=self._engine.image, RUN_OPTIONS=f"--volume {self.folder}:{self.folder}")
        return self

    def __exit__(self, *_):
        self.console("down")
        shutil.rmtree(self.folder, ignore_errors=True)

    def console(self, *arguments):
        return self._engine.run(CONSOLE, *arguments)

    def start(self, node, argv):
        if node in self.processes:
            self.console("start", node)
        else:
            self.console("run", node, *argv)
            self.processes[node] = Container(self, node)
        return self.processes[node]

    def kill(self, node):
        self.console("kill", node)
        self._faulty.discard(node)  # the faults go with the container's network

    def lose(self, percent, origins=None, destinations=None):
        """Between one node and all others, as fleet.sh can; field.py can have any pairs."""
        if percent == 0 and not origins and not destinations:
            for node in self._faulty:
                self.console("heal", node)
            self._faulty.clear()
            return
        for node in origins or destinations or self.nodes:
            self.console("loss", node, percent, "out" if origins else "in")
            self._faulty.add(node)

    def cut(self, node):
        self.console("cut", node)
        self._faulty.add(node)

    def heal(self):
        self.lose(0)

    def is_running(self, node):
        return self._engine.run("docker", "inspect", "--format", "{{.State.Running}}",
                                f"{self._engine.mark}-{node}").strip() == "true"

    def traffic(self, node):
        """Bytes that the node has sent and received in this life of its container."""
        counts = self._engine.run("docker", "exec", f"{self._engine.mark}-{node}", "cat",
                                  "/sys/class/net/eth0/statistics/tx_bytes", "/sys/class/net/eth0/statistics/rx_bytes")
        return tuple(map(int, counts.split()))
