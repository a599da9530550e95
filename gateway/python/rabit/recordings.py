"""Recordings (MCAP) of nodes: decoded values, and tables of them."""

from __future__ import annotations

import fnmatch
import json
import os
import pathlib
import tempfile
import warnings
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _rabit
from ._messages import Message

if TYPE_CHECKING:
    import pandas

_END = 2**64 - 1


class Recorded(NamedTuple):
    """A message of a recording. Times are nanoseconds since 1970 (UTC)."""

    topic: str
    log_time: int  # when it was recorded
    publish_time: int  # when it was posted or sent
    value: Any  # a message; for the recorder's own topics a dict

    @property
    def age(self) -> float:
        """Seconds from the post to the record."""
        return (self.log_time - self.publish_time) * 1e-9


class Topic(NamedTuple):
    """A topic of a recording."""

    name: str
    type: str
    messages: int


class Recording:
    """The messages of one file, or of several on one time line, in the order of their log times."""

    def __init__(self, path: str | os.PathLike[str], temporary: tempfile.TemporaryDirectory[str] | None = None) -> None:
        self._file = _rabit.RecordingFile(os.fspath(path))
        self._temporary = temporary
        self._channels: dict[str, list[int]] = {}
        for number, topic, *_ in self._file.channels:
            self._channels.setdefault(topic, []).append(number)
        self._found: dict[str, str] = {}  # problems of reading by their kind; the newest of each

    @property
    def topics(self) -> list[Topic]:
        found: dict[str, Topic] = {}
        for _, name, kind, _, messages, _ in self._file.channels:
            found[name] = Topic(name, kind, messages + (found[name].messages if name in found else 0))
        return [found[name] for name in sorted(found)]

    @property
    def metadata(self) -> list[tuple[str, dict[str, str]]]:
        """Name and values of each record: the node, its configuration, losses, the merge."""
        return list(self._file.metadata)

    @property
    def span(self) -> tuple[int, int]:
        """The log times of the first and the last message."""
        begin, end = self._file.span
        return int(begin), int(end)

    @property
    def problems(self) -> list[str]:
        """The parts of the file that cannot be read, one line each, and the messages that were asked for so far and that
        cannot be decoded, one line for each topic and reason."""
        return [*self._file.problems, *self._found.values()]

    def __iter__(self) -> Iterator[Recorded]:
        return self.messages()

    def messages(self, *topics: str, start: int = 0, end: int = _END) -> Iterator[Recorded]:
        """Messages of these topics, which may be patterns (`uav?/Pose`; `*` stands for any characters); without any, of all. Raises KeyError, with the
        nearest name, for a topic that is not there. Messages that cannot be decoded are left out; a RuntimeWarning and
        `problems` tell which, and why."""
        channels: set[int] = set()
        for topic in topics or self._channels:
            channels.update(self._find(topic))
        cursor = self._file.messages(channels, start, end)
        no_json: dict[str, int] = {}
        try:
            for name, log_time, publish_time, value in cursor:
                if isinstance(value, str):
                    try:
                        value = json.loads(value)
                    except ValueError:
                        why = f"{name}: no JSON"
                        no_json[why] = no_json.get(why, 0) + 1
                        continue
                yield Recorded(name, log_time, publish_time, value)
        finally:
            self._tell(cursor.problems, {**cursor.undecoded, **no_json})

    def _tell(self, chunks: list[str], undecoded: dict[str, int]) -> None:
        """Keeps problems of reading, and warns of each that was not there before."""
        lines = {line: line for line in chunks if line not in self._file.problems}
        for why, messages in undecoded.items():
            lines[why] = f"{why} ({messages} {'message is' if messages == 1 else 'messages are'} left out)"
        for kind, line in lines.items():
            if kind not in self._found:
                warnings.warn(line, RuntimeWarning, stacklevel=3)
            self._found[kind] = line

    def to_pandas(self, topic: str, *, clock: str = "log") -> pandas.DataFrame:
        """A table of one topic, or of the topics of a pattern (then with a column `topic`), with the time as its index
        (UTC) and a column for each member. Members of members are named `pose.altitude_m`. `clock`: `log`, the time of
        the record, or `publish`, that of the post."""
        import pandas

        if clock not in ("log", "publish"):
            raise ValueError(f"clock: expected `log` or `publish`, not {clock!r}")
        times: list[int] = []
        columns: dict[str, list[Any]] = {}
        if "*" in topic or "?" in topic:
            columns["topic"] = []
        for count, message in enumerate(self.messages(topic)):
            times.append(message.log_time if clock == "log" else message.publish_time)
            row = {"topic": message.topic} if "topic" in columns else {}
            _flatten(message.value, "", row)
            for name, value in row.items():
                columns.setdefault(name, [None] * count).append(value)
            for values in columns.values():
                if len(values) <= count:
                    values.append(None)
        index = pandas.DatetimeIndex(pandas.to_datetime(times, unit="ns", utc=True), name="time")
        return pandas.DataFrame(columns, index=index)

    def _find(self, topic: str) -> Iterable[int]:
        if topic in self._channels:
            return self._channels[topic]
        found = [number for name in fnmatch.filter(self._channels, topic) for number in self._channels[name]]
        if not found:
            raise KeyError(f"the recording has no topic `{topic}`{_rabit.nearest(topic, sorted(self._channels))}")
        return found

    def __repr__(self) -> str:
        begin, end = self.span
        return f"<Recording of {len(self._channels)} topics, {(end - begin) * 1e-9:.1f} s>"


def _flatten(value: Any, prefix: str, row: dict[str, Any]) -> None:
    if isinstance(value, Message):
        value = {name: getattr(value, name) for name in type(value).__match_args__}
    if not isinstance(value, dict):
        row[prefix] = value.name if hasattr(value, "name") and hasattr(value, "value") else value
        return
    for name, member in value.items():
        _flatten(member, f"{prefix}.{name}" if prefix else name, row)


def open(
    *paths: str | os.PathLike[str], reference: str = "", wall_clock: bool = False
) -> Recording:
    """Opens a recording. A folder stands for all recordings in it. Several files, of one or of more nodes, are put on one
    time line first, as `rabit merge` does: by the clock of the node `reference`, or of that which heard most others. The
    clock relations in the files are used, and a node without any is refused unless `wall_clock` is true."""
    files: list[str] = []
    for path in map(pathlib.Path, paths):
        found = sorted(path.glob("*.mcap")) if path.is_dir() else [path]
        if not found:
            raise FileNotFoundError(f"{path}: there is no recording (*.mcap) in it")
        files.extend(map(os.fspath, found))
    if not files:
        raise TypeError("open: expected at least one file or folder")
    if len(files) == 1:
        return Recording(files[0])
    folder = tempfile.TemporaryDirectory(prefix="rabit-")
    merged = os.path.join(folder.name, "merged.mcap")
    _rabit.merge(files, merged, reference, wall_clock)
    return Recording(merged, folder)
