"""Streams that come to a node: values of messages, and messages for its queues."""

from __future__ import annotations

import enum
import sys
import threading
from collections.abc import Callable, Generator
from typing import Any

from . import _async, _log


class Outcome(enum.IntEnum):
    """The end of a message that was sent to a queue."""

    PENDING = 0
    DELIVERED = 1
    EXPIRED = 2
    IN_DOUBT = 3
    REFUSED = 4

    def __str__(self) -> str:
        return f"Outcome.{self.name}"


class Handlers:
    """The threads of a node's handlers."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._threads: set[threading.Thread] = set()

    def start(self, run: Callable[[], None], name: str) -> None:
        def run_to_end() -> None:
            try:
                run()
            finally:
                with self._lock:
                    self._threads.discard(threading.current_thread())

        thread = threading.Thread(target=run_to_end, name=name, daemon=True)
        with self._lock:
            thread.start()
            self._threads.add(thread)

    def join(self) -> None:
        """Waits for their ends. In one of them it returns at once: two that wait for each other would never end."""
        with self._lock:
            threads = set(self._threads)
        if threading.current_thread() not in threads:
            for thread in threads:
                thread.join()


class _Stream:
    """One after the other: `for`, `async for`, `get`, or a handler on a thread of its own."""

    def __init__(self, core: Any, handlers: Handlers) -> None:
        self._core = core
        self._readable = _async.Readable(core)
        self._handlers = handlers
        self._has_handler = False

    @property
    def name(self) -> str:
        return str(self._core.name)

    def __iter__(self) -> Any:
        return self

    def __next__(self) -> Any:
        while True:
            item = self._core.take()
            if item is not None:
                return item
            if self._core.is_closed:
                raise StopIteration
            self._core.wait(None)

    def __aiter__(self) -> Any:
        return self

    async def __anext__(self) -> Any:
        while True:
            item = self._core.take()
            if item is not None:
                return item
            if self._core.is_closed:
                raise StopAsyncIteration
            await self._readable.wait()

    def get(self, timeout: float | None = None) -> Any:
        """The next one; raises TimeoutError after so many seconds, and RuntimeError if the node was stopped."""
        while True:
            item = self._core.take()
            if item is not None:
                return item
            if self._core.is_closed:
                raise RuntimeError(f"{self.name}: the node was stopped")
            if not self._core.wait(timeout):
                raise TimeoutError(f"{self.name}: nothing came in {timeout} s")

    def on(self, handler: Callable[[Any], object]) -> Callable[[Any], object]:
        """Calls the handler with each one, on a thread of its own. An exception is logged with its traceback, and
        the next one is handled. Also as a decorator. To be used once."""
        if self._has_handler:
            raise RuntimeError(f"{self.name} has a handler already")
        self._handlers.start(lambda: self._run(handler), f"rabit {self.name}")
        self._has_handler = True
        return handler

    def _run(self, handler: Callable[[Any], object]) -> None:
        for item in self:
            try:
                handler(item)
            except Exception:
                kind, value, trace = sys.exc_info()
                assert kind is not None and value is not None
                _log.exception(f"handler of {self.name}", kind, value, trace)

    def close(self) -> None:
        """Nothing comes any more."""
        self._core.close()


class Subscription(_Stream):
    """Values of a message, of one node or of many. Each is a `Received` with `value`, `node`, `age` and `stamp`.

    A slow reader gets the newest value of each node, not all that came meanwhile.
    """

    def latest(self) -> dict[str, Any]:
        """The newest value of each node, by its name; "" is this node. Takes nothing away from `for`."""
        return {received.node: received for received in self._core.all()}


class Queue(_Stream):
    """Messages that other nodes sent to a queue of this node: all of them, in their order. Each is a `Command` with
    `value` and `redelivered`. While it is full, its senders wait."""

    def __len__(self) -> int:
        return int(self._core.waiting)


class Receipt:
    """A message that was sent. `await` it, or `wait()`, for its outcome; or look at `outcome` at any time."""

    def __init__(self, core: Any, loop: _async.OutcomeLoop) -> None:
        self._core = core
        self._outcomes = loop

    @property
    def outcome(self) -> Outcome:
        """PENDING until the outcome is known."""
        return Outcome(self._core.outcome)

    @property
    def done(self) -> bool:
        return self.outcome != Outcome.PENDING

    @property
    def reason(self) -> str:
        """Why the message was refused at the call, in the words of the gateway; empty if it was not."""
        return str(self._core.reason)

    @property
    def counts(self) -> dict[Outcome, int]:
        """The number of nodes that have each outcome, for a message to `*/Queue`."""
        return {outcome: count for outcome, count in zip(Outcome, self._core.counts)}

    def wait(self, timeout: float | None = None) -> Outcome:
        """Returns the outcome, or PENDING after so many seconds."""
        self._core.wait(timeout)
        return self.outcome

    async def _known(self) -> Outcome:
        if not self.done:
            await self._outcomes.wait(self._core)
        return self.outcome

    def __await__(self) -> Generator[Any, None, Outcome]:
        return self._known().__await__()

    def __repr__(self) -> str:
        why = f": {self.reason}" if self.reason else ""
        return f"<Receipt {self._core.address} {self.outcome.name}{why}>"


__all__ = ["Outcome", "Queue", "Receipt", "Subscription"]
