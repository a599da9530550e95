"""A library of C++ in a node of Python: a generated type and a manager, and what Python costs beside it.

RABIT_PING: the library. `python3 test_library.py SECONDS` measures.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import rabit

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
        end = time.monotonic() + 3
        while time.monotonic() < end or not reader.fleet().is_up("source"):
            source.post("Ping", ping(sent_ns=time.monotonic_ns(), fill=bytes(88)))
            time.sleep(0.02)
        poses = reader.subscribe("source/Ping", ping)
        assert poses.get(timeout=5).value.sent_ns > 0
    assert int(result.read_text().split()[0]) > 10


def measure(kind, domain, seconds):
    """One reader: prints how many came, their median in microseconds, and the share of a core, in percent."""
    rabit.load_library(LIBRARY)
    ping = rabit.message_class("PythonBench::Ping")
    late = []
    libraries = [LIBRARY] if kind == "cpp" else []
    node = rabit.Node(f"reader.{kind}", libraries=libraries, **settings(domain),
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
        print(kind, count, median, 100 * used / seconds)
    else:
        print(kind, len(late), statistics.median(late) / 1000, 100 * used / seconds)


class Source(rabit.Manager):
    period = 0.001

    def __init__(self, ping):
        self.ping = ping(fill=bytes(88))

    def unit_of_work(self):
        self.ping.sent_ns = time.monotonic_ns()
        self.post("Ping", self.ping)


def main(seconds):
    rabit.load_library(LIBRARY)
    ping = rabit.message_class("PythonBench::Ping")
    domain = 99
    with rabit.Node("source", publish=PING, managers=[Source(ping)], **settings(domain)):
        with tempfile.NamedTemporaryFile() as result:
            readers = [subprocess.Popen([sys.executable, __file__, kind, str(domain), str(seconds)],
                                        env={**os.environ, "PING_RESULT": result.name})
                       for kind in ("cpp", "thread", "loop")]
            for reader in readers:
                reader.wait()


if __name__ == "__main__":
    if len(sys.argv) == 2:
        main(float(sys.argv[1]))
    else:
        measure(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
