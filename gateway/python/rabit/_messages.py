"""The classes of IDL types. The extension module makes them, by the functions at the end."""

from __future__ import annotations

import enum
import keyword
from typing import Any

from . import _rabit


class Message:
    """A value of an IDL struct: its members are attributes, with the defaults of the IDL file.

    Members are given by name or in order, and converted to their types: what does not fit is a TypeError or
    ValueError that names the member. Sequences and arrays of numbers are numpy arrays, other sequences lists.
    Values compare by their members. They can be copied, pickled, and matched by `match`.
    """

    __slots__ = ()
    __match_args__: tuple[str, ...] = ()
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, /, *members: Any, **named: Any) -> None:
        _rabit.init(self, members, named)

    def __setattr__(self, name: str, value: Any) -> None:
        _rabit.set_member(self, name, value)

    def __getattr__(self, name: str) -> Any:
        names = list(type(self).__match_args__)
        raise AttributeError(f"{type(self).__qualname__} has no member `{name}`{_rabit.nearest(name, names)}")

    def __repr__(self) -> str:
        members = ", ".join(f"{name}={getattr(self, name)!r}" for name in type(self).__match_args__)
        return f"{type(self).__qualname__}({members})"

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_equal(getattr(self, name), getattr(other, name)) for name in type(self).__match_args__)

    def __copy__(self) -> Any:
        return type(self)(*(getattr(self, name) for name in type(self).__match_args__))

    def __deepcopy__(self, memo: Any) -> Any:
        return type(self)(**asdict(self))

    def __reduce__(self) -> Any:
        kind = _rabit.type_of_class(self)
        if kind is None:
            raise TypeError(f"{type(self).__qualname__} is pickled as a part of a message only")
        return _restored, (kind.name, kind.idl_text, _rabit.encode(self))


class Union:
    """A value of an IDL union: `case` is the name of the selected member, `value` its value."""

    __slots__ = ("case", "value", "_label")
    __match_args__ = ("case", "value")
    __hash__ = None  # type: ignore[assignment]
    _cases: tuple[str, ...] = ()

    def __init__(self, /, **selected: Any) -> None:
        if len(selected) != 1:
            raise TypeError(f"{type(self).__qualname__}: expected one of {', '.join(self._cases)}")
        ((self.case, self.value),) = selected.items()
        if self.case not in self._cases:
            hint = _rabit.nearest(self.case, list(self._cases))
            raise TypeError(f"{type(self).__qualname__} has no member `{self.case}`{hint}")
        self._label = _rabit.label_of(type(self), self.case)

    def __getattr__(self, name: str) -> Any:
        if name in self._cases and name == self.case:
            return self.value
        raise AttributeError(f"{type(self).__qualname__}: `{name}` is not selected, but `{self.case}`")

    @classmethod
    def _of(cls, case: str | None, value: Any, label: int) -> Any:
        made = cls.__new__(cls)
        made.case = case  # type: ignore[assignment]
        made.value = value
        made._label = label
        return made

    def __repr__(self) -> str:
        return f"{type(self).__qualname__}({self.case}={self.value!r})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return NotImplemented
        return self.case == other.case and self._label == other._label and _equal(self.value, other.value)


def asdict(message: Message) -> dict[str, Any]:
    """The members by name; members that are messages become dicts, too."""
    return {name: _plain(getattr(message, name)) for name in type(message).__match_args__}


def replace(message: Any, **named: Any) -> Any:
    """A copy with some members changed."""
    members = {name: getattr(message, name) for name in type(message).__match_args__}
    return type(message)(**{**members, **named})


def _plain(value: Any) -> Any:
    if isinstance(value, Message):
        return asdict(value)
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return value.copy() if hasattr(value, "dtype") else value


def _equal(left: Any, right: Any) -> bool:
    if hasattr(left, "dtype") and hasattr(right, "dtype"):
        return left.shape == right.shape and bool((left == right).all())
    if isinstance(left, list) and isinstance(right, list):
        return len(left) == len(right) and all(map(_equal, left, right))
    return bool(left == right)


def _restored(name: str, idl_text: str, sample: bytes) -> Any:
    return _rabit.decode(_rabit.parse_idl(idl_text, name), sample)


# The extension module calls the functions below.


def python_name(name: str) -> str:
    """The attribute of a member: a word of Python gets `_` behind it."""
    return name + "_" if keyword.iskeyword(name) else name


def _qualname(name: str) -> str:
    return name.replace("::", ".")


def _named(cls: Any, name: str) -> Any:
    cls.__qualname__ = _qualname(name)
    cls.__module__ = "rabit.idl"
    cls.__idl_name__ = name
    return cls


def make_struct(name: str, members: list[str]) -> Any:
    names = tuple(members)
    return _named(type(name.rpartition("::")[2], (Message,), {"__slots__": names, "__match_args__": names}), name)


def make_union(name: str, members: list[str]) -> Any:
    return _named(type(name.rpartition("::")[2], (Union,), {"__slots__": (), "_cases": tuple(members)}), name)


def make_enum(name: str, values: list[tuple[str, int]]) -> Any:
    return _named(enum.IntEnum(name.rpartition("::")[2], values), name)


def make_bitmask(name: str, values: list[tuple[str, int]]) -> Any:
    return _named(enum.IntFlag(name.rpartition("::")[2], values), name)
