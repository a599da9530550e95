"""Nodes in containers. One container of each node holds its network and its namespace of processes for the whole run. Each
life of the node is a command in it by `docker exec`: with the user, the rights and the limits that Docker gives."""

import json
import os
import shutil
import signal
import subprocess

from rabit_lab import processes
from rabit_lab.network import Spaces, run
from rabit_lab.radio import Unsupported

START_S = 60


class Containers(Spaces):
    """Spaces of a fleet in which some nodes have an image. A container lives as long as its standard input, which ends with
    this process, also by SIGKILL; and all processes in it end with it. Nodes write to the folder `results`, and read the
    folders `readable`. All containers of the run have `label`."""

    def __init__(self, scenario, results, readable, label):
        if os.geteuid() != 0 or not shutil.which("docker"):
            raise Unsupported("nodes with an `image` need root and Docker; docker/packages-docker.txt lists what to install")
        self._scenario, self._label = scenario, label
        self._mounts = [f"{results}:{results}", *(f"{path}:{path}:ro" for path in sorted(readable - {str(results)}))]
        self._holders = {}  # node -> Process
        self._pids = {}
        self._images = {}

    def _image(self, node):
        found = self._scenario.nodes.get(node)
        return found.image if found else None

    def make(self, node):
        image = self._image(node)
        if not image:
            super().make(node)
            return
        self._images[node] = json.loads(run("docker", "image", "inspect", image))[0]["Config"]
        name = self._name(node)
        mounts = [word for mount in self._mounts for word in ("--volume", mount)]
        self._holders[node] = processes.Process(["docker", "run", "--rm", "--interactive", "--network", "none", "--name", name,
                                                 "--label", self._label, *mounts, "--entrypoint", "cat", image])
        self._pids[node] = processes.until(lambda: self._pid_of(name, node), START_S)
        self.ip(node, "link", "set", "lo", "up")

    def _name(self, node):
        return f"{self._label}-{node}"

    def _pid_of(self, name, node):
        if not self._holders[node].running():
            raise Unsupported(f"docker run: {' '.join(text for _, text in self._holders[node].lines)}")
        done = subprocess.run(["docker", "inspect", "--format", "{{.State.Pid}}", name], text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        return int(done.stdout) if done.stdout.strip().isdigit() else 0

    def path(self, node):
        return f"/proc/{self._pids[node]}/ns/net" if node in self._pids else super().path(node)

    def inside(self, node, argv):
        """With the network of the node and the files of this machine."""
        if node not in self._pids:
            return super().inside(node, argv)
        return ["nsenter", "--target", str(self._pids[node]), "--net", *argv]

    def start(self, node, argv, environment):
        """The command of a node, in its container."""
        if node not in self._pids:
            return super().start(node, argv, environment)
        image = self._images[node]
        argv = argv or [*(image.get("Entrypoint") or []), *(image.get("Cmd") or [])]
        words = [word for pair in environment.items() for word in ("--env", "=".join(pair))]
        return ["docker", "exec", "--interactive", *words, self._name(node), *argv], {}

    def signal(self, node, process, number):
        """To all processes of the container but its first, which holds it."""
        if node not in self._pids:
            super().signal(node, process, number)
            return
        subprocess.run(["nsenter", "--target", str(self._pids[node]), "--pid", "sh", "-c", f"kill -{int(number)} -1"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)

    def ended(self, node):
        """Its children end, too."""
        if node in self._pids:
            self.signal(node, None, signal.SIGKILL)

    def ip(self, node, *argv):
        if node in self._pids:
            run("nsenter", "--target", str(self._pids[node]), "--net", "ip", *argv)
        else:
            super().ip(node, *argv)

    def end(self):
        for holder in self._holders.values():
            holder.close_input()
        for holder in self._holders.values():
            try:
                holder.exit_code(20)
            except subprocess.TimeoutExpired:
                holder.kill()


def remove(label):
    """The containers of a run that was ended while they were made, and so were never started."""
    left = subprocess.run(["docker", "ps", "--all", "--quiet", "--filter", f"label={label}"], text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout.split()
    if left:
        subprocess.run(["docker", "rm", "--force", *left], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
