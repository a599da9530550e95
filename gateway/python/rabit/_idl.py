"""Message classes from IDL."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from typing import Any

from . import _rabit
from ._messages import Message


class Namespace:
    """A module of IDL: its types, constants and modules are attributes."""

    def __init__(self, name: str = "") -> None:
        self._name = name
        self._names: dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return self._names[name]
        except KeyError:
            where = self._name or "the IDL file"
            hint = _rabit.nearest(name, sorted(self._names))
            raise AttributeError(f"{where} has no `{name}`{hint}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._names]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __repr__(self) -> str:
        return f"<IDL {self._name or 'file'}: {', '.join(self._names)}>"

    def _add(self, path: str, value: Any) -> None:
        first, _, rest = path.partition("::")
        if not rest:
            self._names[first] = value
            return
        inner = self._names.setdefault(first, Namespace(f"{self._name}.{first}" if self._name else first))
        if isinstance(inner, Namespace):
            inner._add(rest, value)

    def _add_class(self, cls: Any, comments: dict[str, str]) -> None:
        """Adds a class and those of its members."""
        if isinstance(cls, tuple):
            self._add_class(cls[1], comments)
            return
        if not isinstance(cls, type):
            return
        name: str = cls.__idl_name__  # type: ignore[attr-defined]
        self._add(name, cls)
        members = _rabit.members(cls)
        lines = [comments.get(name, "")] if name in comments else []
        for member, kind in members:
            comment = comments.get(f"{name}.{member}", "")
            lines.append(f"    {member}: {_kind_text(kind)}{'  # ' + comment if comment else ''}")
            self._add_class(kind, comments)
        if lines and (name in comments or not cls.__doc__ or members):
            cls.__doc__ = "\n".join(lines)


def _kind_text(kind: Any) -> str:
    if isinstance(kind, tuple):
        return f"array of {_kind_text(kind[1])}" if kind[0] else f"list of {_kind_text(kind[1])}"
    return kind.__qualname__ if isinstance(kind, type) else str(kind)


def load_idl(path: str | os.PathLike[str], include: Iterable[str | os.PathLike[str]] = ()) -> Namespace:
    """Makes the classes of an IDL file: `load_idl("uav.idl").Uav.Pose`.

    Files that it includes are looked for beside it and in `include`. The types are the same as those that C++
    programs have from that file. Raises ValueError with `file:line: reason`.
    """
    messages, constants, comments = _rabit.load_idl(os.fspath(path), [os.fspath(folder) for folder in include])
    idl = Namespace()
    for message in messages:
        idl._add_class(message.cls, comments)
    for name, value in constants:
        idl._add(name, json.loads(value))
    return idl


def message_class(name: str) -> Any:
    """The class of a type that this process knows by its IDL name, also from C++: `message_class("Uav::Pose")`.

    Raises KeyError with the nearest name.
    """
    cls = _rabit.type_of(name).cls
    Namespace()._add_class(cls, {})
    return cls


def to_bytes(value: Message) -> bytes:
    """The DDS sample of a message."""
    return bytes(_rabit.encode(value))


def from_bytes(cls: Any, sample: bytes) -> Any:
    """The message of a DDS sample; raises ValueError if it is none of that class."""
    return _rabit.decode(_rabit.type_of_class(cls), sample)


def to_json(value: Message) -> str:
    """A message as JSON, in the form of the program rabit."""
    return str(_rabit.to_json(value))


def from_json(cls: Any, text: str) -> Any:
    """The message of such a JSON; members that it does not name have their defaults."""
    return _rabit.from_json(_rabit.type_of_class(cls), text)
