"""Recordings of Python nodes: read, put on one time line, as tables."""

import struct
import time
import zlib

import pytest

import rabit
from conftest import wait_until


@pytest.fixture(scope="module")
def flight(tmp_path_factory, idl):
    """Two aircraft that hear each other and a command, recorded by both."""
    folder = tmp_path_factory.mktemp("flight")
    network = {"domain": 230, "transport": rabit.transports()[0], "interfaces": ["127.0.0.1"],
               "publish": {"Pose": idl.Uav.Pose}, "accept": {"MissionControl": [idl.Uav.Goto]},
               "record": {"folder": str(folder)}}
    uav1, uav2 = (rabit.Node(name, **network) for name in ("uav1", "uav2"))
    with uav1, uav2:
        poses = uav2.subscribe("uav1/Pose", idl.Uav.Pose)
        for number in range(1, 11):
            uav1.post("Pose", idl.Uav.Pose(altitude_m=100 + number, number=number))
            assert poses.get(timeout=120).value.number == number
            if number == 1:  # the recorders find the message in their own time
                wait_until(lambda: all(any(found(folder, node, "uav1/Pose")) for node in ("uav1", "uav2")))
        wait_until(lambda: uav2.send("uav1/MissionControl", idl.Uav.Goto(id=7)).outcome is not rabit.Outcome.REFUSED)
        uav1.queue("MissionControl").get(timeout=120)
        wait_until(lambda: any(map(knows_the_other_clock, found(folder, "uav2", "uav2/Recorder/Clocks"))))
    return folder


def found(folder, node, topic):
    """The messages of that topic in the file of the node, as far as they are on the disk."""
    try:
        return list(rabit.open(next(folder.glob(f"{node}*.mcap"))).messages(topic))
    except (StopIteration, RuntimeError, KeyError):  # no file, or no beginning of one, or no such topic
        return []


def knows_the_other_clock(clocks):
    return any(peer["uncertain_by_ns"] is not None for peer in clocks.value["peers"])


TEXT = b"\0\1\0\0" + struct.pack("<I", 3) + b"hi\0"


def foreign_file(path, schema_encoding, schema, *samples, encoding="cdr"):
    """Writes a recording of the topic /chatter as other programs do. One sample stands for three."""
    def text(value):
        return struct.pack("<I", len(value)) + value

    def record(kind, body):
        return bytes([kind]) + struct.pack("<Q", len(body)) + body

    samples = samples * 3 if len(samples) == 1 else samples
    described = record(3, struct.pack("<H", 1) + text(b"Text") + text(schema_encoding.encode()) + text(schema))
    described += record(4, struct.pack("<HH", 1, 1) + text(b"/chatter") + text(encoding.encode()) + struct.pack("<I", 0))
    inner = described + b"".join(record(5, struct.pack("<HIQQ", 1, number, 10 + number, 10 + number) + sample)
                                 for number, sample in enumerate(samples))
    out = b"\x89MCAP0\r\n" + record(1, text(b"other") + text(b"x"))
    start = len(out)
    chunk = record(6, struct.pack("<QQQI", 10, 12, len(inner), zlib.crc32(inner)) + text(b"") + struct.pack("<Q", len(inner)) + inner)
    out += chunk + record(15, struct.pack("<I", 0))
    summary = len(out)
    out += described + record(8, struct.pack("<QQQQ", 10, 12, start, len(chunk)) + struct.pack("<IQ", 0, 0) + text(b"")
                              + struct.pack("<QQ", len(inner), len(inner)))
    path.write_bytes(out + record(2, struct.pack("<QQI", summary, 0, 0)) + b"\x89MCAP0\r\n")
    return path


def test_a_recording_gives_decoded_values(flight, idl):
    recording = rabit.open(next(flight.glob("uav1*.mcap")))
    poses = list(recording.messages("uav1/Pose"))
    assert [pose.value.number for pose in poses] == list(range(1, 11))
    assert all(isinstance(pose.value, idl.Uav.Pose) and 0 <= pose.age < 1 for pose in poses)
    assert {topic.name: topic.type for topic in recording.topics}["uav1/Pose"] == "Uav::Pose"
    (command,) = recording.messages("uav1/Recorder/received/*")
    assert command.value == idl.Uav.Goto(id=7)
    assert any(isinstance(message.value, dict) for message in recording)
    begin, end = recording.span
    assert begin < poses[0].log_time < end
    assert list(recording.messages("uav1/Pose", start=poses[5].log_time))[0] == poses[5]


def test_live_values_of_a_message_that_is_backfilled_are_recorded(idl, one_network, tmp_path):
    with rabit.Node("uav1", publish={"Pose": idl.Uav.Pose}, **one_network) as uav1, \
         rabit.Node("ground", record={"folder": str(tmp_path), "backfill": ["Pose"]},
                    subscribe=[{"message": "Pose", "type": idl.Uav.Pose}], **one_network) as ground:
        poses = ground.subscribe("uav1/Pose", idl.Uav.Pose)
        for number in range(1, 6):
            uav1.post("Pose", idl.Uav.Pose(number=number))
            assert poses.get(timeout=120).value.number == number
        wait_until(lambda: [pose.value.number for pose in found(tmp_path, "ground", "uav1/Pose")] == [1, 2, 3, 4, 5])


def test_an_unknown_topic_is_named_with_the_nearest(flight):
    recording = rabit.open(next(flight.glob("uav1*.mcap")))
    with pytest.raises(KeyError, match="no topic `uav1/Poze`; did you mean `uav1/Pose`"):
        list(recording.messages("uav1/Poze"))


def test_a_topic_is_a_table(flight):
    pytest.importorskip("pandas")
    table = rabit.open(next(flight.glob("uav1*.mcap"))).to_pandas("uav1/Pose")
    assert table["altitude_m"].tolist() == [100.0 + number for number in range(1, 11)]
    assert str(table.index.dtype) == "datetime64[ns, UTC]" and table.index.is_monotonic_increasing


def test_recordings_of_several_nodes_are_on_one_time_line(flight):
    recording = rabit.open(flight)
    names = {topic.name for topic in recording.topics}
    assert {"uav1/Pose", "uav2/Recorder/knew/uav1/Pose"} <= names
    times = [message.log_time for message in recording]
    assert times == sorted(times)
    pytest.importorskip("pandas")
    assert set(recording.to_pandas("uav?/Pose")["topic"]) == {"uav1/Pose"}


def test_messages_that_cannot_be_decoded_are_told(tmp_path):
    recording = rabit.open(foreign_file(tmp_path / "other.mcap", "ros2msg", b"string data", TEXT))
    with pytest.warns(RuntimeWarning, match="/chatter.*3 messages are left out"):
        assert list(recording.messages("/chatter")) == []
    (problem,) = recording.problems
    assert problem.startswith("/chatter: ") and problem.endswith("(3 messages are left out)")
    list(recording.messages("/chatter"))  # each problem is told once, and is one line
    assert recording.problems == [problem]


def test_samples_that_do_not_fit_their_type_are_told(tmp_path):
    recording = rabit.open(foreign_file(tmp_path / "short.mcap", "omgidl", b"struct Text { string data; };", b"\0\1\0\0\x09"))
    with pytest.warns(RuntimeWarning, match="/chatter: the bytes do not fit the type"):
        assert list(recording) == []


def test_json_that_is_none_is_told_and_the_rest_is_read(tmp_path):
    recording = rabit.open(foreign_file(tmp_path / "json.mcap", "", b"", b"{no", b'{"is": 1}', encoding="json"))
    with pytest.warns(RuntimeWarning, match="/chatter: no JSON"):
        assert [message.value for message in recording] == [{"is": 1}]


def test_a_table_of_messages_that_cannot_be_decoded_is_told(tmp_path):
    pytest.importorskip("pandas")
    recording = rabit.open(foreign_file(tmp_path / "other.mcap", "ros2msg", b"string data", TEXT))
    with pytest.warns(RuntimeWarning, match="/chatter"):
        assert len(recording.to_pandas("/chatter")) == 0


def test_what_is_no_recording_is_one_line(tmp_path):
    (tmp_path / "x.mcap").write_bytes(b"no")
    with pytest.raises(RuntimeError, match="is no recording"):
        rabit.open(tmp_path / "x.mcap")
    with pytest.raises(RuntimeError, match="none.mcap"):
        rabit.open(tmp_path / "none.mcap")
    with pytest.raises(FileNotFoundError, match="there is no recording"):
        rabit.open(_empty(tmp_path))


def _empty(folder):
    (folder / "empty").mkdir()
    return folder / "empty"
