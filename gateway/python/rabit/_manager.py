"""Managers that are written in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _rabit
from ._streams import Receipt

if TYPE_CHECKING:
    from ._node import Node


class Manager:
    """A manager beside those in C++: a thread that runs `unit_of_work` and sleeps.

    It runs once in each `period` (seconds), and whenever it is woken: by a post of a message in `wake_on`
    (`{"uav1/Pose": idl.Uav.Pose}`), by a change of the claims or the table if `wake_on_agreement` is true, or by `wake()`.
    Without a period it runs once in a second at least. An exception is logged with its traceback, and reported in the
    manager's status; the manager goes on.
    """

    name = ""  # empty: the name of the class
    period = 0.0
    wake_on: dict[str, Any] = {}
    wake_on_agreement = False

    node: Node
    _core: Any = None

    def startup(self) -> None:
        """Called first, on the manager's thread."""

    def unit_of_work(self) -> None:
        raise NotImplementedError(f"{type(self).__name__} has no unit_of_work")

    def shutdown(self) -> None:
        """Called last, on the manager's thread."""

    def wake(self) -> None:
        """Runs the unit of work soon. Any thread."""
        self._core.wake()

    @property
    def is_turn(self) -> bool:
        """True if the unit of work runs because its period has come, and not only because it was woken."""
        return bool(self._core.is_turn)

    def post(self, message: str, value: Any) -> None:
        self.node.post(message, value)

    def send(self, address: str, value: Any, *, expire: float | None = None) -> Receipt:
        return self.node.send(address, value, expire=expire)

    def _join(self, node: Node, core: Any) -> None:
        self.node = node
        self._core = core.add_manager(self.name or type(self).__name__, self, float(self.period))
        for message, cls in self.wake_on.items():
            if message in node._queues:
                self._core.wake_on_queue(node._queues[message]._core)
            else:
                self._core.wake_on(message, _rabit.type_of_class(cls))
        if self.wake_on_agreement:
            self._core.wake_on_agreement(core.agreement())
