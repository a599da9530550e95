"""Waits for what comes, in an event loop: file descriptors that threads of C++ write to."""

from __future__ import annotations

import asyncio
from typing import Any


class Readable:
    """Wakes coroutines of one event loop when something of the extension module is ready."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self._loop: asyncio.AbstractEventLoop | None = None
        self._waiting: list[asyncio.Future[None]] = []

    async def wait(self) -> None:
        """Returns when the core is ready, or may be."""
        loop = asyncio.get_running_loop()
        if self._loop is not loop:
            self.close()
            self._loop = loop
            loop.add_reader(self._core.fd, self._on_ready)
        self._core.arm()
        if self._core.is_ready:
            return
        future: asyncio.Future[None] = loop.create_future()
        self._waiting.append(future)
        try:
            await future
        finally:
            if future in self._waiting:
                self._waiting.remove(future)

    def _on_ready(self) -> None:
        self._core.drain()
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            if not future.done():
                future.set_result(None)

    def close(self) -> None:
        """Leaves the event loop."""
        loop, self._loop = self._loop, None
        if loop is not None and not loop.is_closed():
            loop.remove_reader(self._core.fd)
            self._on_ready()


class OutcomeLoop:
    """Futures of outcomes, in one event loop."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self._loop: asyncio.AbstractEventLoop | None = None
        self._futures: dict[int, asyncio.Future[None]] = {}

    async def wait(self, receipt: Any) -> None:
        loop = asyncio.get_running_loop()
        if self._loop is not loop:
            self.close()
            self._loop = loop
            loop.add_reader(self._core.outcomes_fd, self._on_known)
        self._core.arm_outcomes()
        future: asyncio.Future[None] = loop.create_future()
        self._futures[receipt.number] = future
        try:
            if not receipt.tell_loop():
                await future
        finally:
            self._futures.pop(receipt.number, None)

    def _on_known(self) -> None:
        self._core.arm_outcomes()
        for number in self._core.take_outcomes():
            future = self._futures.get(number)
            if future is not None and not future.done():
                future.set_result(None)

    def close(self) -> None:
        loop, self._loop = self._loop, None
        if loop is not None and not loop.is_closed():
            loop.remove_reader(self._core.outcomes_fd)
            self._on_known()
