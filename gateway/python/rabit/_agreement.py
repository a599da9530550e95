"""The claims and the shared table of a node."""

from __future__ import annotations

from collections.abc import Generator
from types import TracebackType
from typing import Any

from . import _async

_TOO_MANY = "64 claims are wanted here, or were until a moment ago"


class Claim:
    """A claim that this node asked for: the result of `node.claims.acquire`. `await` it, or `wait()`, until it is decided.
    At the end of a `with` block it is released.

    Look at `still_mine` before each effect. That is a look, not a guard: a program that is suspended after it acts too
    late. A receiver that refuses an earlier `fence` is a guard."""

    def __init__(self, agreed: Any, name: str, refusal: str = "") -> None:
        self._agreed = agreed
        self._name = name
        self._refusal = refusal
        self._waits: dict[str, tuple[Any, _async.Readable]] = {}

    @property
    def name(self) -> str:
        return self._name

    @property
    def fence(self) -> int | None:
        """The number under which this node holds the claim now. Each holder has a higher one than each holder before it.
        None: this node does not hold it."""
        fence: int | None = self._agreed.status(self._name)[1]
        return fence

    @property
    def still_mine(self) -> bool:
        """True if this node holds the claim now."""
        return self.fence is not None

    @property
    def wanted(self) -> bool:
        """True if this node holds the claim, or asks for it."""
        return bool(self._agreed.status(self._name)[0])

    @property
    def holder(self) -> str:
        """The node that holds the claim, as far as this one has heard; empty: not known."""
        return str(self._agreed.status(self._name)[2])

    @property
    def reason(self) -> str:
        """Why this node does not hold the claim, as far as there was an answer."""
        wanted, _, _, reason = self._agreed.status(self._name)
        return str(reason if wanted or not self._refusal else self._refusal)

    def wait(self, timeout: float | None = None) -> bool:
        """Waits until this node holds the claim. False: not in so many seconds, or it is not wanted any more, as `reason`
        tells, or the node was stopped."""
        if not self.still_mine and self.wanted:
            self._until("until_decided")[0].wait(timeout)
        return self.still_mine

    def wait_lost(self, timeout: float | None = None) -> bool:
        """Waits until this node does not hold the claim. False: it still does after so many seconds, or while the node
        ends."""
        if self.still_mine:
            self._until("until_lost")[0].wait(timeout)
        return not self.still_mine

    async def lost(self) -> None:
        """Returns once this node does not hold the claim, or ends."""
        if self.still_mine:
            await self._ready("until_lost")

    def release(self) -> None:
        """From now on this node does not hold the claim, nor asks for it."""
        self._agreed.release(self._name)

    async def _decided(self) -> bool:
        if not self.still_mine and self.wanted:
            await self._ready("until_decided")
        return self.still_mine

    async def _ready(self, what: str) -> None:
        core, readable = self._until(what)
        while not core.is_ready:
            await readable.wait()

    def _until(self, what: str) -> tuple[Any, _async.Readable]:
        if what not in self._waits:
            core = getattr(self._agreed, what)(self._name)
            self._waits[what] = (core, _async.Readable(core))
        return self._waits[what]

    def __await__(self) -> Generator[Any, None, bool]:
        return self._decided().__await__()

    def __enter__(self) -> Claim:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.release()

    def __repr__(self) -> str:
        fence = self.fence
        return f"<Claim {self._name} {f'under fence {fence}' if fence is not None else 'not held'}>"


class Claims:
    """Claims of which one node has each at any time: a cell to fly, a target to look at, the lead. `Rabit::Claims` in C++
    has the promise and its conditions."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._agreed = node.agreement()

    def acquire(self, claim: str, *, once: bool = False) -> Claim:
        """Asks for a claim until it is released, also after a loss, or with `once` until it is refused or lost. A claim that
        is asked for before the node starts waits for that. A name has 1 to 64 bytes."""
        self._node.check()
        return Claim(self._agreed, claim, "" if self._agreed.acquire(claim, once) else _TOO_MANY)

    def release(self, claim: str) -> None:
        """From now on this node does not hold the claim, nor asks for it. Others get it a moment later."""
        self._agreed.release(claim)

    def still_mine(self, claim: str) -> bool:
        """True if this node holds the claim now: look again before each effect."""
        return Claim(self._agreed, claim).still_mine

    def fence(self, claim: str) -> int | None:
        """The number under which this node holds the claim now; None: it does not."""
        return Claim(self._agreed, claim).fence

    def holder(self, claim: str) -> str:
        """The node that holds the claim, as far as this one has heard; empty: not known."""
        return Claim(self._agreed, claim).holder

    def reason(self, claim: str) -> str:
        """Why this node does not hold the claim, as far as there was an answer."""
        return Claim(self._agreed, claim).reason

    def mine(self) -> list[str]:
        """The claims that this node holds now, by name."""
        return list(self._agreed.mine())


class SharedTable:
    """Small values that all nodes with an `agreement` share, and that merge. `Rabit::SharedTable` in C++ has the promise and
    its conditions.

    `write`, `add` and `raise_` return why the value was refused, in words; empty: it is done. A key keeps the kind of its
    first use. Keys have 1 to 64 bytes."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._agreed = node.agreement()

    def write(self, key: str, value: str) -> str:
        """Writes a text of at most 64 bytes. Of texts that were written at the same time, one is kept."""
        self._node.check_network()
        return str(self._agreed.write(key, value))

    def add(self, key: str, number: int) -> str:
        """Adds a number from 0 to 511 to a set."""
        self._node.check_network()
        return str(self._agreed.add(key, number))

    def raise_(self, key: str, number: int) -> str:
        """Keeps the highest number, of 64 bits with a sign."""
        self._node.check_network()
        return str(self._agreed.raise_(key, number))

    def read(self, key: str) -> str | set[int] | int | None:
        """The value as it was written, added or raised: a text, a set or a number. None: the key is not known here."""
        self._node.check_network()
        value: str | set[int] | int | None = self._agreed.read(key)
        return value

    def keys(self) -> list[str]:
        self._node.check_network()
        return list(self._agreed.keys())


__all__ = ["Claim", "Claims", "SharedTable"]
