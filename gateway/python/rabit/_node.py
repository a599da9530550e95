"""A node of the fleet."""

from __future__ import annotations

import asyncio
import atexit
import json
import os
import weakref
from collections.abc import Iterable, Mapping
from types import TracebackType
from typing import Any

from . import _async, _rabit
from ._agreement import Claims, SharedTable
from ._fleet import Fleet
from ._manager import Manager
from ._messages import Message
from ._streams import Handlers, Queue, Receipt, Subscription

_running: weakref.WeakSet[Node] = weakref.WeakSet()


class Node:
    """A node: a member of the fleet, in a `with` or `async with` block.

    `config` is a file, as for programs in C++; all settings of such a file (gateway/README.md) may be given by name,
    too, and count more. For types, classes may be given:

        rabit.Node("planner", domain=7, publish={"Plan": idl.Uav.Plan}, accept={"Commands": [idl.Uav.Goto]})

    Messages to publish, queues and managers are known before the node starts. The network is served by threads that
    never wait for Python.
    """

    def __init__(
        self,
        name: str = "",
        *,
        config: str | os.PathLike[str] = "",
        publish: Mapping[str, Any] | Iterable[Mapping[str, Any]] = (),
        accept: Mapping[str, Any] | Iterable[Mapping[str, Any]] = (),
        managers: Iterable[Manager] = (),
        libraries: Iterable[str | os.PathLike[str]] = (),
        queue_capacity: int = 1000,
        **settings: Any,
    ) -> None:
        for library in libraries:
            _rabit.load_library(os.fspath(library))  # its types may stand in the configuration
        given = dict(settings)
        given["publish"] = _entries(publish, "message", lambda value: {"type": value})
        given["accept"] = _entries(
            accept, "queue", lambda value: {"types": [value] if isinstance(value, (type, str)) else list(value)}
        )
        text = json.dumps({key: value for key, value in given.items() if value != []}, default=_plain)
        self._core = _rabit.NodeCore(os.fspath(config), name, text, set(settings))
        self._queues: dict[str, Queue] = {}
        self._handlers = Handlers()
        self._managers: list[Manager] = []
        self._outcomes = _async.OutcomeLoop(self._core)
        for queue in self._core.accepts:
            self._queues[queue] = Queue(self._core.add_queue(queue, queue_capacity), self._handlers)
        for library in libraries:
            self._core.add_library(os.fspath(library))
        for manager in managers:
            self.add_manager(manager)

    @property
    def name(self) -> str:
        return str(self._core.name)

    @property
    def is_running(self) -> bool:
        return bool(self._core.is_running)

    def add_manager(self, manager: Manager) -> None:
        """Before the node starts."""
        self._managers.append(manager)  # the core holds it from the start on
        manager._join(self, self._core)

    def start(self) -> None:
        """Joins the network; a `with` block does it. Raises ConfigError, and RuntimeError in a process that was forked
        while nodes ran."""
        if _has_locks_of_others:
            raise RuntimeError(
                f"the node `{self.name}` cannot start: this process was forked while nodes ran; make it with `subprocess`, "
                "or `multiprocessing.get_context('spawn')`, or before the first node starts"
            )
        _running.add(self)  # first, so that a Ctrl-C in between leaves no node that nobody ends
        try:
            self._core.start()
        except BaseException:
            if not self._core.has_threads:
                _running.discard(self)
            raise

    def stop(self) -> None:
        """Leaves the network. Messages without an outcome get one, and all iterations end.

        In a manager of this node it returns at once: iterations and managers are told to end, and the node has ended
        when its `with` block has."""
        if not self._core.stop():
            return
        _running.discard(self)
        self._handlers.join()

    def __enter__(self) -> Node:
        self.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.stop()

    async def __aenter__(self) -> Node:
        try:
            await _async.in_thread(self.start)
        except asyncio.CancelledError:
            await asyncio.shield(_async.in_thread(self.stop))  # a start that has begun goes on
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        await asyncio.shield(_async.in_thread(self.stop))

    def subscribe(self, message: str, type: Any) -> Subscription:
        """Values of `Pose` of one node (`uav1/Pose`), of nodes that fit a pattern (`uav*/Pose`), or of this node
        (`Pose`), also of foreign topics. `type` is the class of the message."""
        pattern, slash, rest = message.partition("/")
        core = self._core.subscribe(pattern if slash else "", rest if slash else message, _type_of(type))
        return Subscription(core, self._handlers)

    def queue(self, name: str) -> Queue:
        """The queue of that name, which is among those that the node accepts."""
        try:
            return self._queues[name]
        except KeyError:
            hint = _rabit.nearest(name, sorted(self._queues))
            raise KeyError(f"the node `{self.name}` accepts no queue `{name}`{hint}") from None

    def post(self, message: str, value: Message) -> None:
        """Posts a local message. It goes to other nodes if `publish` names it."""
        self._core.post(message, value)

    def send(self, address: str, value: Message, *, expire: float | None = None) -> Receipt:
        """Sends a message to a queue: `uav1/MissionControl`, `*/MissionControl` for all live nodes that accept it, or
        the name of a queue here. It is never delivered later than `expire` seconds after this call; all messages to
        one queue of a node live equally long.

        `await` the result, or `wait()`, for the outcome. A message that is refused at once has its `reason`."""
        return Receipt(self._core.send(address, value, expire), self._outcomes)

    def fleet(self) -> Fleet:
        """The other nodes and what keeps data from flowing, as of now."""
        return Fleet(self._core.fleet())

    @property
    def claims(self) -> Claims:
        """The claims of this node. Raises ConfigError without `agreement=` or that section of the file."""
        return Claims(self._core)

    @property
    def table(self) -> SharedTable:
        """The table that this node shares with all others that have an `agreement`. Raises ConfigError likewise."""
        return SharedTable(self._core)

    def messages(self) -> list[str]:
        """The names of the messages here, and of those that other nodes announce."""
        return list(self._core.messages())

    def flush(self, timeout: float = 1.0) -> bool:
        """Waits until the gateway has taken what was posted before. False: not in so many seconds."""
        return bool(self._core.flush(timeout))

    def __repr__(self) -> str:
        return f"<Node {self.name}{'' if self.is_running else ', not running'}>"


def _entries(entries: Any, key: str, rest: Any) -> list[dict[str, Any]]:
    """The entries of a section, which may be a dict by the name of the message or queue."""
    if isinstance(entries, Mapping):
        return [{key: name, **(value if isinstance(value, Mapping) else rest(value))} for name, value in entries.items()]
    return [dict(entry) for entry in entries]


def _plain(value: Any) -> Any:
    """Returns the text that a configuration file has in place of the value."""
    if isinstance(value, type):
        return _type_of(value).name
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{value!r} cannot stand in a configuration")


def _type_of(value: Any) -> Any:
    if isinstance(value, str):
        return _rabit.type_of(value)
    found = _rabit.type_of_class(value)
    if found is None:
        raise TypeError(f"expected the class of an IDL message, not {value!r}")
    return found


@atexit.register
def _stop_all() -> None:
    """Before the interpreter ends, all its nodes do."""
    for node in list(_running):
        node.stop()


_has_locks_of_others = False


def _after_fork() -> None:
    """In a forked process, locks that threads of nodes held at that moment stay locked, also those within DDS."""
    global _has_locks_of_others
    _has_locks_of_others = _has_locks_of_others or len(_running) > 0
    _running.clear()


os.register_at_fork(after_in_child=_after_fork)
