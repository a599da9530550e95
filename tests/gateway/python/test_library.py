"""A library of C++ in a node of Python: a generated type and a manager, and what Python costs beside it.

RABIT_PING: the library. `python3 test_library.py SECONDS` measures.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import rabit
from conftest import wait_until

LIBRARY = os.environ.get("RABIT_PING", "")
PING = [{"message": "Ping", "type": "PythonBench::Ping", "qos": "telemetry"}]


def settings(domain):
    return {"domain": domain, "transport": os.environ.get("RABIT_TRANSPORT", rabit.transports()[0]),
            "interfaces": ["127.0.0.1"]}


def test_a_manager_of_cpp_reads_what_python_posts_in_a_type_of_cpp(tmp_path, monkeypatch, one_network):
    result = tmp_path / "result"
    monkeypatch.setenv("PING_RESULT", str(result))
    rabit.load_library(LIBRARY)
    ping = rabit.message_class("PythonBench::Ping")
    reader = rabit.Node("reader", libraries=[LIBRARY], **one_network,
                        subscribe=[{"message": "Ping", "type": ping, "from": ["source"]}])
    with reader, rabit.Node("source", publish=PING, **one_network) as source:
        pings = reader.subscribe("source/Ping", ping)
        heard = threading.Semaphore(0)
        pings.on(lambda one: heard.release())

        def hear_another():
            source.post("Ping", ping(sent_ns=time.monotonic_ns(), fill=bytes(88)))
            return heard.acquire(timeout=0.02)

        for _ in range(20):
            wait_until(hear_another)
        assert pings.latest()["source"].value.sent_ns > 0
    # The manager of C++ may skip what is replaced before it comes to its turn.
    assert int(result.read_text().split()[0]) > 0


class Counts(rabit.Manager):
    def __init__(self, ping):
        self.wake_on = {"Ping": ping}
        self.turns = 0

    def unit_of_work(self):
        self.turns += 1


def test_a_manager_of_python_is_woken_by_one_of_cpp_in_its_reactor(one_network):
    rabit.load_library(LIBRARY)
    ping = rabit.message_class("PythonBench::Ping")
    counts = Counts(ping)
    with rabit.Node("source", publish=PING, managers=[counts], libraries=[LIBRARY], **one_network) as node:
        pings = node.subscribe("Ping", ping)
        first, second = pings.get(timeout=120), pings.get(timeout=120)
        assert 0 < first.value.sent_ns < second.value.sent_ns
        wait_until(lambda: counts.turns > 10)


def measure(kind, seconds):
    """One reader: prints how many came in a second, how late, and what of a core its process took."""
    rabit.load_library(LIBRARY)
    ping = rabit.message_class("PythonBench::Ping")
    late = []
    libraries = [LIBRARY] if kind == "cpp" else []
    node = rabit.Node(f"reader.{kind}", libraries=libraries, **settings(7),
                      subscribe=[{"message": "Ping", "type": ping, "from": ["source"]}])
    with node:
        pings = node.subscribe("source/Ping", ping) if kind != "cpp" else None
        if kind == "loop":
            import asyncio

            def run(until):
                asyncio.run(read_all(until))

            async def read_all(until):
                async def forever():
                    async for one in pings:
                        late.append(time.monotonic_ns() - one.value.sent_ns)

                task = asyncio.ensure_future(forever())
                await asyncio.sleep(until - time.monotonic())
                task.cancel()
        elif kind == "thread":
            def run(until):
                while (left := until - time.monotonic()) > 0:
                    try:
                        one = pings.get(left)
                    except TimeoutError:
                        return
                    late.append(time.monotonic_ns() - one.value.sent_ns)
        else:
            def run(until):
                time.sleep(until - time.monotonic())
        run(time.monotonic() + 3)
        late.clear()
        before = resource.getrusage(resource.RUSAGE_SELF)
        run(time.monotonic() + seconds)
        after = resource.getrusage(resource.RUSAGE_SELF)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if kind == "cpp":
        count, median = open(os.environ["PING_RESULT"]).read().split()
        rate = int(count) / (seconds + 3)
    else:
        rate, median = len(late) / seconds, statistics.median(late) / 1000
    print(f"{os.environ['RABIT_TRANSPORT']:12} {kind:6} {rate:5.0f} messages/s  median {float(median) / 1000:.3f} ms  "
          f"{100 * used / seconds:4.1f} % of a core", flush=True)


def main(seconds):
    import conftest  # noqa: F401 - a loopback of its own, for the readers, too

    rabit.load_library(LIBRARY)
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.0f}, Python {sys.version.split()[0]}")
    for transport in rabit.transports():
        os.environ["RABIT_TRANSPORT"] = transport
        with rabit.Node("source", publish=PING, libraries=[LIBRARY], **settings(7)):
            with tempfile.NamedTemporaryFile() as result:
                readers = [subprocess.Popen([sys.executable, __file__, kind, str(seconds)],
                                            env={**os.environ, "PING_RESULT": result.name})
                           for kind in ("cpp", "thread", "loop")]
                for reader in readers:
                    reader.wait()


if __name__ == "__main__":
    if len(sys.argv) == 2:
        main(float(sys.argv[1]))
    else:
        measure(sys.argv[1], float(sys.argv[2]))
