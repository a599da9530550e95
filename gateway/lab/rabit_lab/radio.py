"""The program radio/ that carries the frames of a network, and its console."""

import json
import time

from rabit_lab import processes

LIMIT_S = 60  # only keeps a broken program from hanging its user


class Unsupported(Exception):
    """This machine does not allow what is needed."""


class Radio:
    """A channel between namespaces, which lives as long as this process. `spaces`: {node: namespace}, a name below
    /run/netns or a path."""

    def __init__(self, program, spaces, rate=0, queue=16000, overhead=0, seed=1, pcap=None, device="eth0"):
        argv = [program, "--rate", round(rate), "--queue", queue, "--overhead", overhead, "--seed", seed,
                "--device", device]
        argv += ["--pcap", pcap] if pcap else []
        for node, space in spaces.items():
            argv += ["--node", f"{node}={space}"]
        self._process = processes.Process(argv)
        try:
            _, self.ready = self._process.wait_for(lambda text: text.startswith("{") and json.loads(text), LIMIT_S)
        except AssertionError as error:
            if "/dev/net/tun" in str(error) or "a TAP device" in str(error):
                said = str(error).splitlines()[-1]
                raise Unsupported(f"no TAP devices here: {said}; run modprobe tun, and let this user open /dev/net/tun; in a "
                                  "container: --device /dev/net/tun") from error
            raise

    @property
    def pid(self):
        return self._process.pid

    def tell(self, line):
        """A command of radio/Console.h, and the answer."""
        self._process.lines.clear()
        asked = time.monotonic()
        self._process.tell(line)
        _, answer = self._process.wait_for(lambda text: text.startswith("{") and json.loads(text), LIMIT_S, asked)
        if "error" in answer:
            raise ValueError(f"{line}: {answer['error']}")
        return answer

    def running(self):
        return self._process.running()

    def kill(self):
        self._process.kill()
