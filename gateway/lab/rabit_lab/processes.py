"""Processes that end with their maker whatever happens to it, and their lines as they come."""

import ctypes
import os
import signal
import subprocess
import threading
import time


def die_with_parent():
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGKILL)


class Pauses:
    """Times at which the machine stood still, or gave no processor time to a process that wanted little: a node on it
    could not beat either. `seen`: [(begin, end)], by the monotonic clock, in s."""

    LOOK_S = 0.1
    LEAST_S = 0.5

    def __init__(self):
        self.seen = []
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)
        self._thread.start()

    def _look(self):
        before = time.monotonic()
        while not self._ended.wait(self.LOOK_S):
            now = time.monotonic()
            if now - before > self.LOOK_S + self.LEAST_S:
                self.seen.append((before, now))
            before = now

    def end(self):
        """What was seen, at the end."""
        self._ended.set()
        self._thread.join()
        return self.seen


def until(holds, limit_s=300):
    """What `holds` returns once it is true. The limit only keeps a broken program from hanging its user."""
    end = time.monotonic() + limit_s
    while True:
        result = holds()
        if result:
            return result
        assert time.monotonic() < end, f"{holds.__name__} did not come true within {limit_s} s"
        time.sleep(0.05)


def full_pipe():
    """Both ends of a pipe that takes nothing more."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    try:
        while True:
            os.write(writing, b"x" * 4096)
    except BlockingIOError:
        pass
    os.set_blocking(writing, True)
    return reading, writing


# Folders of keys that the lab's user has in use: its nodes and tools get their own.
KEYS_OF_THE_USER = {"RABIT_KEYS", "RABIT_NODE_KEYS"}


def environment_of_children():
    return {name: value for name, value in os.environ.items() if name not in KEYS_OF_THE_USER}


class Process:
    """A child process and the lines that it has written so far. With `unread`, its output is a pipe that is full and that
    nobody reads. `on_line(text)` is called with each line, on a thread of the process, which then keeps none."""

    def __init__(self, argv, env=None, unread=False, on_line=None, **how):
        self.argv = [str(a) for a in argv]
        self.lines = []  # (time, text)
        self._on_line = on_line
        self._changed = threading.Condition()
        self._full_pipe = full_pipe() if unread else None
        output = self._full_pipe[1] if unread else subprocess.PIPE
        self._popen = subprocess.Popen(self.argv, stdin=subprocess.PIPE, stdout=output, stderr=subprocess.STDOUT, text=True,
                                       bufsize=1, errors="replace", env={**environment_of_children(), **(env or {})},
                                       preexec_fn=die_with_parent, **how)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def pid(self):
        return self._popen.pid

    def _read(self):
        for line in self._popen.stdout or ():
            if self._on_line:
                self._on_line(line.rstrip("\n"))
                continue
            with self._changed:
                self.lines.append((time.monotonic(), line.rstrip("\n")))
                self._changed.notify_all()
        with self._changed:
            self._changed.notify_all()

    def wait_for(self, found, seconds, since=0.0):
        """Waits until `found(text)` holds for a line written after `since`; returns (time, what found returned).
        The limit only keeps a broken test from hanging."""
        end = time.monotonic() + seconds
        seen = 0
        with self._changed:
            while True:
                for when, text in self.lines[seen:]:
                    result = found(text) if when >= since else None
                    if result:
                        return when, result
                seen = len(self.lines)
                left = end - time.monotonic()
                if left <= 0 or (self._popen.poll() is not None and not self._reader.is_alive()
                                 and seen == len(self.lines)):
                    tail = "\n".join(text for _, text in self.lines[-40:])
                    raise AssertionError(f"not seen within {seconds} s in the output of {self.argv}:\n{tail}")
                self._changed.wait(left)

    def tell(self, line):
        """A line on its standard input."""
        self._popen.stdin.write(line + "\n")
        self._popen.stdin.flush()

    def close_input(self):
        self._popen.stdin.close()

    def signal(self, number):
        self._popen.send_signal(number)

    def kill(self):
        self._popen.kill()
        return self._popen.wait()

    def terminate(self, seconds=120):
        """SIGTERM, and the exit code."""
        self._popen.send_signal(signal.SIGTERM)
        return self.exit_code(seconds)

    def exit_code(self, seconds):
        code = self._popen.wait(timeout=seconds)
        self._reader.join(timeout=seconds)
        return code

    def running(self):
        return self._popen.poll() is None


class Processes:
    """Starts processes and ends those that still run when the block is left."""

    def __init__(self):
        self._started = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self._started:
            if process.running():
                process.kill()

    def start(self, argv, env=None):
        process = Process(argv, env)
        self._started.append(process)
        return process

    def pids(self):
        """Of those that run."""
        return [process.pid for process in list(self._started) if process.running()]
