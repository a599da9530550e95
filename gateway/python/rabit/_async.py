"""Waits for what comes, in an event loop: file descriptors that threads of C++ write to."""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
from collections.abc import Callable, Iterator
from typing import Any


def in_thread(call: Callable[[], None]) -> asyncio.Future[None]:
    """Runs the call on a thread of its own: the threads of the loop's executor may all wait for the node."""
    executor = concurrent.futures.ThreadPoolExecutor(1, "rabit")
    try:
        return asyncio.get_running_loop().run_in_executor(executor, call)
    finally:
        executor.shutdown(wait=False)


class _Waiters:
    """Futures of one event loop, which reads the file descriptor while there are any, and one turn longer: mostly the next
    wait begins in that turn. No longer: a loop keeps alive what it reads for."""

    def __init__(self, fd: Callable[[], int], on_ready: Callable[[], None]) -> None:
        self._fd = fd  # made when it is first asked for
        self._on_ready = on_ready
        self._loop: asyncio.AbstractEventLoop | None = None
        self.futures: set[asyncio.Future[None]] = set()

    @contextlib.contextmanager
    def one_more(self) -> Iterator[asyncio.Future[None]]:
        loop = asyncio.get_running_loop()
        if self._loop is not loop:
            if self._loop is not None and self.futures and not self._loop.is_closed():
                raise RuntimeError("another event loop waits here already")
            loop.add_reader(self._fd(), self._read, loop)
            self._loop = loop
            self.futures = set()
        future: asyncio.Future[None] = loop.create_future()
        self.futures.add(future)
        try:
            yield future
        finally:
            self.futures.discard(future)
            if not self.futures and not loop.is_closed():
                loop.call_soon(self._leave, loop)

    def _read(self, loop: asyncio.AbstractEventLoop) -> None:
        if self._loop is loop:
            self._on_ready()

    def _leave(self, loop: asyncio.AbstractEventLoop) -> None:
        if self._loop is loop:
            if self.futures:
                return
            self._loop = None
        loop.remove_reader(self._fd())


def _finish(futures: set[asyncio.Future[None]]) -> None:
    for future in futures:
        if not future.done():
            future.set_result(None)


class Readable:
    """Wakes coroutines of one event loop when something of the extension module is ready."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self._waiters = _Waiters(lambda: int(core.fd), self._on_ready)

    async def wait(self) -> None:
        """Returns when the core is ready, or may be."""
        with self._waiters.one_more() as future:
            self._core.arm()
            if not self._core.is_ready:
                await future

    def _on_ready(self) -> None:
        self._core.drain()
        _finish(self._waiters.futures)


class OutcomeLoop:
    """Futures of outcomes, in one event loop."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self._waiters = _Waiters(lambda: int(core.outcomes_fd), self._on_known)
        self._by_receipt: dict[int, set[asyncio.Future[None]]] = {}

    async def wait(self, receipt: Any) -> None:
        with self._waiters.one_more() as future:
            futures = self._by_receipt.setdefault(receipt.number, set())
            futures.add(future)
            try:
                self._core.arm_outcomes()
                if not receipt.tell_loop():
                    await future
            finally:
                futures.discard(future)
                if not futures:
                    self._by_receipt.pop(receipt.number, None)

    def _on_known(self) -> None:
        for number in self._core.take_outcomes():
            _finish(self._by_receipt.get(number, set()))
