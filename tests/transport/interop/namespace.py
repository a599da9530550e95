"""Network namespaces for tests that change the network under nodes."""

import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402


def supported():
    return harness.can_make_namespaces()


class Holder:
    """A network namespace that lives as long as this object, held by a process in it."""

    def __init__(self):
        self.process = subprocess.Popen(["unshare", "--net", "sh", "-c", "echo ready; exec cat"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True, preexec_fn=harness.die_with_parent)
        self.process.stdout.readline()
        self._helpers = []

    def keep_running(self, *argv):
        """In the background, until this object is closed or its maker dies."""
        self._helpers.append(subprocess.Popen([*self.inside(), *argv], stdout=subprocess.DEVNULL,
                                              stderr=subprocess.DEVNULL, preexec_fn=harness.die_with_parent))

    def run(self, *argv):
        subprocess.run([*self.inside(), *argv], check=True)

    def inside(self):
        return ["nsenter", "--net", "--target", str(self.process.pid)]

    def close(self):
        for process in (*self._helpers, self.process):
            process.kill()
            process.wait()
