"""Nodes in containers: the files of an image around a node, and a container's network namespace in place of the lab's own. The
node's process is still the lab's, so that it is started, frozen and killed like any other."""

import json
import os
import shutil
import subprocess

from rabit_lab import processes
from rabit_lab.network import Spaces, run
from rabit_lab.radio import Unsupported

START_S = 60


class Containers(Spaces):
    """Spaces of a fleet in which some nodes have an image. A container lives as long as its standard input, which ends with
    this process, also by SIGKILL."""

    def __init__(self, scenario, folders):
        if os.geteuid() != 0 or not shutil.which("docker"):
            raise Unsupported("nodes with an `image` need root and Docker; docker/packages-docker.txt lists what to install")
        self._scenario, self._folders = scenario, folders
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
        name = f"rabit-lab-{os.getpid()}-{node}"
        mounts = [word for folder in self._folders for word in ("--volume", f"{folder}:{folder}")]
        self._holders[node] = processes.Process(["docker", "run", "--rm", "--interactive", "--network", "none", "--name", name,
                                                 *mounts, "--entrypoint", "cat", image])
        self._pids[node] = processes.until(lambda: self._pid_of(name, node), START_S)
        self.ip(node, "link", "set", "lo", "up")

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
        """The command of a node, with the files and the environment of its image."""
        if node not in self._pids:
            return super().start(node, argv, environment)
        image = self._images[node]
        argv = argv or [*(image.get("Entrypoint") or []), *(image.get("Cmd") or [])]
        words = dict(pair.split("=", 1) for pair in image.get("Env") or [] if "=" in pair)
        folder = image.get("WorkingDir") or "/"
        return (["nsenter", "--target", str(self._pids[node]), "--net", "--mount", "--uts", "--ipc", "--root", f"--wd={folder}",
                 "env", *(f"{key}={value}" for key, value in {**words, **environment}.items()), *argv], {})

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
