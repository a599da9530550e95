"""Nodes come and go in one process, several at a time, while everything raises. Nothing may be left of them.

RABIT_STRESS: for so many seconds; continuous integration has a short form.
"""

import asyncio
import concurrent.futures
import contextlib
import gc
import itertools
import logging
import os
import random
import select
import signal
import threading
import time

import pytest

import rabit
from conftest import DOMAINS, wait_until

SECONDS = float(os.environ.get("RABIT_STRESS", "15"))
NUMBERS = itertools.count()


class Trouble(Exception):
    pass


class Raises(rabit.Manager):
    """Raises in one of its functions, and may stop its node."""

    period = 0.002

    def __init__(self, where, goto):
        self.name = f"Raises{where}"
        self.where = where
        self.wake_on = {"Order": goto}

    def _raise_in(self, name):
        if name == self.where:
            raise Trouble(name)

    def startup(self):
        self._raise_in("startup")

    def unit_of_work(self):
        if self.where == "stop":
            self.node.stop()
        self._raise_in("unit_of_work")

    def shutdown(self):
        self._raise_in("shutdown")


def settings(transport):
    return {"domain": next(DOMAINS), "transport": transport, "interfaces": ["127.0.0.1"]}


def make(idl, network, **more):
    return rabit.Node(f"node{next(NUMBERS)}", publish={"Pose": idl.Uav.Pose}, accept={"Commands": [idl.Uav.Goto]},
                      **network, **more)


def misuse(idl, node):
    for wrong in (lambda: node.post("Pose", 5), lambda: node.post("Pose", idl.Uav.Goto()), lambda: idl.Uav.Goto(id="x"),
                  lambda: node.queue("none"), lambda: node.subscribe("a/b", str), lambda: rabit.Node("x", domin=7)):
        with pytest.raises((TypeError, KeyError, ValueError)):
            wrong()
    assert node.send("nobody/Commands", idl.Uav.Goto()).outcome is rabit.Outcome.REFUSED


def exchange(idl, transport, folder):
    """Two nodes in threads, with handlers that raise, and messages without an outcome at the end."""
    network = settings(transport)
    first, second = make(idl, network, record={"folder": os.fspath(folder)}), make(idl, network)
    with first, second:
        heard = threading.Event()

        @second.subscribe("node*/Pose", idl.Uav.Pose).on
        def handle(pose):
            heard.set()
            raise Trouble("handler")

        first.queue("Commands").on(lambda command: 1 / 0)
        wait_until(lambda: first.post("Pose", idl.Uav.Pose(number=1)) or heard.is_set(), 120)
        for _ in range(20):
            second.send(f"{first.name}/Commands", idl.Uav.Goto())
        misuse(idl, first)
    for file in folder.glob(f"{first.name}*"):
        file.unlink()


def managers(idl, transport):
    for where in ("startup", "unit_of_work", "shutdown", "stop"):
        with make(idl, settings(transport), managers=[Raises(where, idl.Uav.Goto)]) as node:
            if where == "stop":
                assert list(node.subscribe("Pose", idl.Uav.Pose)) == []
            else:
                node.post("Order", idl.Uav.Goto())
                node.flush(5)


def unused(idl, transport):
    """Nodes that are never started, or cannot be."""
    make(idl, settings(transport), managers=[Raises("startup", idl.Uav.Goto)])
    node = make(idl, {**settings(transport), "transport": "none"})
    with pytest.raises(rabit.ConfigError):
        node.start()


async def loop(idl, transport):
    """Waits that are cancelled, at any time."""
    with contextlib.suppress(asyncio.TimeoutError):
        async with asyncio.timeout(random.random() / 4):
            async with make(idl, settings(transport)) as node:
                poses = node.subscribe("Pose", idl.Uav.Pose)

                async def read():
                    async for pose in poses:
                        raise Trouble(pose)

                tasks = [asyncio.create_task(read()) for _ in range(3)]
                await asyncio.sleep(random.random() / 50)
                tasks[0].cancel()
                node.post("Pose", idl.Uav.Pose(number=1))
                receipt = node.send("Commands", idl.Uav.Goto())
                waits = [asyncio.ensure_future(receipt) for _ in range(3)]
                waits[0].cancel()
                await asyncio.gather(*waits, *tasks[:2], return_exceptions=True)
                tasks[2].cancel()
                await asyncio.sleep(1)


def interrupted(idl, transport):
    """Ctrl-C, wherever it comes. In the main thread."""
    node = make(idl, settings(transport), managers=[Raises("unit_of_work", idl.Uav.Goto)])
    timer = threading.Timer(random.random() / 4, os.kill, [os.getpid(), signal.SIGINT])
    try:
        timer.start()
        with node:
            for _ in node.subscribe("Pose", idl.Uav.Pose):
                pass
    except KeyboardInterrupt:
        pass
    finally:
        timer.join()
        node.stop()


def in_fork(function):
    """Runs it in a forked process, which must end well. The limit only keeps a broken test from hanging."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            function()
            code = 0
        finally:
            os._exit(code)
    with open(os.pidfd_open(child), closefd=True) as ended:
        has_ended = select.select([ended], [], [], 240)[0]
    if not has_ended:
        os.kill(child, signal.SIGKILL)
    assert os.waitpid(child, 0)[1] == 0 and has_ended


def forked(idl, transport):
    def beside(node):
        with pytest.raises(RuntimeError, match="forked process"):
            node.post("Pose", idl.Uav.Pose())
        with pytest.raises(RuntimeError, match="was forked while nodes ran"):
            make(idl, settings(transport)).start()

    def alone():
        with make(idl, settings(transport)) as own:
            own.post("Pose", idl.Uav.Pose())

    with make(idl, settings(transport)) as node:
        in_fork(lambda: beside(node))
    in_fork(alone)


def left():
    """Returns the files, threads and kB of memory that this process holds."""
    gc.collect()
    with open("/proc/self/statm") as file:
        memory = int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1000
    return len(os.listdir("/proc/self/fd")), len(os.listdir("/proc/self/task")), memory


def one_round(idl, folder, pool):
    jobs = [pool.submit(exchange, idl, transport, folder) for transport in rabit.transports()]
    jobs += [pool.submit(managers, idl, transport) for transport in rabit.transports()]
    for transport in rabit.transports():
        unused(idl, transport)
        asyncio.run(loop(idl, transport))
        interrupted(idl, transport)
    for job in jobs:
        job.result()
    forked(idl, random.choice(rabit.transports()))


def test_nothing_is_left_of_nodes_that_came_and_went(idl, tmp_path):
    for name in ("rabit", "asyncio"):
        logging.getLogger(name).setLevel(100)
    rabit.set_log_level("off")
    pool = concurrent.futures.ThreadPoolExecutor(4)
    begin = time.monotonic()
    seen = []
    with pool:
        while time.monotonic() < begin + SECONDS or len(seen) < 6:
            one_round(idl, tmp_path, pool)
            seen.append((next(NUMBERS), *left()))
            print(*seen[-1], flush=True)
    print(f"{seen[-1][0]} nodes in {time.monotonic() - begin:.0f} s")
    third = len(seen) // 3
    warm, last = seen[third:2 * third], seen[-third:]
    # The kernel may list a thread for a while after its end, so the least of several rounds counts here, too.
    assert min(files for _, files, *_ in last) <= warm[0][1], "files"
    assert min(threads for *_, threads, _ in last) <= max(threads for *_, threads, _ in warm), "threads"
    # Allocators keep some MB for a while, so the least of many rounds counts. It grew by up to 2 MB in short runs, and by
    # 0.2 MB in ten minutes.
    grown = min(memory for *_, memory in last) - min(memory for *_, memory in warm)
    assert grown < 3000 + (last[0][0] - warm[0][0]) / 4, "memory"
