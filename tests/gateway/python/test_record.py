"""Each key of `record:`, of a node in Python: the files hold what the key says."""

import os
import threading
import time

import pytest

import rabit
from conftest import wait_until
from test_recordings import found

END = b"\x89MCAP0\r\n"  # of a file that was ended


def files(folder):
    """Recordings, the oldest first."""
    return sorted(folder.glob("*.mcap"))


def topics(folder):
    return {topic.name for file in files(folder) for topic in rabit.open(file).topics}


def numbers(folder, node, topic="uav1/Pose"):
    return [message.value.number for message in found(folder, node, topic)]


class Aircraft:
    """The node uav1, which publishes Pose, Plan and Alarm and records itself."""

    def __init__(self, idl, network, folder, record, **settings):
        self.pose = idl.Uav.Pose
        self.folder = folder
        self.count = 0
        publish = [{"message": name, "type": self.pose, "qos": "telemetry"} for name in ("Pose", "Plan", "Alarm")]
        self.node = rabit.Node("uav1", publish=publish, record={"folder": str(folder), "free": "0B", **record}, **settings,
                               **network)

    def __enter__(self):
        self.node.__enter__()
        return self

    def __exit__(self, *error):
        return self.node.__exit__(*error)

    def post(self, *names):
        self.count += 1
        for name in names or ("Pose",):
            self.node.post(name, self.pose(number=self.count))
        return self.count

    def post_until(self, holds, *names):
        """Posts until that is true."""
        def posted():
            self.post(*names)
            return holds()
        return wait_until(posted)

    def post_for(self, seconds, *names):
        end = time.monotonic() + seconds
        self.post_until(lambda: time.monotonic() >= end, *names)

    def is_recorded(self, topic="uav1/Pose"):
        return bool(found(self.folder, "uav1", topic))


def test_folder_is_where_the_files_are(idl, one_network, tmp_path):
    folder = tmp_path / "made" / "here"
    with Aircraft(idl, one_network, folder, {}) as uav1:
        uav1.post_until(uav1.is_recorded)
    assert [file.name.startswith("uav1_000001_") for file in files(folder)] == [True]
    assert {"uav1/Pose", "uav1/Gateway/Fleet", "uav1/Recorder/Managers"} <= topics(folder)


def test_messages_are_those_that_are_recorded(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"messages": ["Po*"]}) as uav1:
        uav1.post_until(uav1.is_recorded, "Pose", "Plan")
    assert "uav1/Pose" in topics(tmp_path) and not topics(tmp_path) & {"uav1/Plan", "uav1/Alarm", "uav1/Gateway/Fleet"}


def test_except_leaves_messages_out(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"except": ["P*n", "Gateway/*"]}) as uav1:
        uav1.post_until(uav1.is_recorded, "Pose", "Plan", "Alarm")
    assert {"uav1/Pose", "uav1/Alarm"} <= topics(tmp_path) and not topics(tmp_path) & {"uav1/Plan", "uav1/Gateway/Fleet"}


@pytest.mark.parametrize("queues", [True, False])
def test_queues_are_recorded_unless_they_are_off(idl, one_network, tmp_path, queues):
    accept = {"MissionControl": [idl.Uav.Goto]}
    with Aircraft(idl, one_network, tmp_path, {"queues": queues}, accept=accept) as uav1, \
         rabit.Node("ground", accept=accept, **one_network) as ground:
        wait_until(lambda: ground.send("uav1/MissionControl", idl.Uav.Goto(id=7)).outcome is not rabit.Outcome.REFUSED)
        assert uav1.node.queue("MissionControl").get(timeout=120).value.id == 7
        wait_until(lambda: uav1.node.send("ground/MissionControl", idl.Uav.Goto(id=8)).outcome is not rabit.Outcome.REFUSED)
        assert ground.queue("MissionControl").get(timeout=120).value.id == 8
        uav1.post_until(uav1.is_recorded)
    came, sent = (f"uav1/Recorder/{what}/ground/MissionControl/Uav::Goto" for what in ("received", "sent"))
    told = [values for name, values in rabit.open(files(tmp_path)[0]).metadata if name == "rabit.not_recorded"]
    if queues:
        assert [message.value.id for topic in (came, sent) for message in found(tmp_path, "uav1", topic)] == [7, 8]
        assert not any("queue messages" in values for values in told)
    else:
        assert not [topic for topic in topics(tmp_path) if "MissionControl" in topic]
        assert any("queue messages" in values for values in told)


class Turning(rabit.Manager):
    period = 0.02

    def __init__(self, name):
        self.name = name
        self.turns = threading.Semaphore(0)

    def unit_of_work(self):
        self.turns.release()


def test_steps_are_those_of_the_managers_that_it_names(idl, one_network, tmp_path):
    managers = [Turning("Planner"), Turning("Other")]
    with Aircraft(idl, one_network, tmp_path, {"steps": ["Plan*"]}, managers=managers) as uav1:
        for manager in managers:
            assert all(manager.turns.acquire(timeout=120) for _ in range(5))
        wait_until(lambda: len(found(tmp_path, "uav1", "uav1/Recorder/Steps/Planner")) >= 5)
        assert uav1.node.is_running
    assert "uav1/Recorder/Steps/Other" not in topics(tmp_path)


def test_split_size_ends_a_file(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"split_size": "1MB"}) as uav1:
        picture = idl.Uav.Picture(jpeg=os.urandom(90_000))  # so that they are not compressed
        wait_until(lambda: uav1.node.post("Picture", picture) or len(files(tmp_path)) >= 3)
    assert all(0.9e6 < file.stat().st_size < 2e6 for file in files(tmp_path)[:2])


def test_split_time_ends_a_file(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"split_time": "1s"}) as uav1:
        uav1.post_until(lambda: len(files(tmp_path)) >= 3)
    found_numbers = [message.value.number for file in files(tmp_path) for message in rabit.open(file).messages()
                     if message.topic == "uav1/Pose"]
    assert sorted(set(found_numbers)) == list(range(found_numbers[0], uav1.count + 1)), "none is lost between two files"


def test_keep_removes_the_oldest_files(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"split_size": "1MB", "keep": "4MB"}) as uav1:
        picture = idl.Uav.Picture(jpeg=os.urandom(90_000))
        wait_until(lambda: uav1.node.post("Picture", picture) or list(tmp_path.glob("uav1_000008_*")))
    assert not list(tmp_path.glob("uav1_000001_*"))
    assert sum(file.stat().st_size for file in files(tmp_path)) <= 7e6
    written = [int(file.name.split("_")[1]) for file in files(tmp_path)]
    assert written == list(range(written[0], written[-1] + 1)) and written[-1] >= 8


def test_free_stays_free(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"free": "1000TB"}) as uav1:
        uav1.post_until(lambda: any("are to stay free" in problem.reason for problem in uav1.node.fleet().problems))
    assert "uav1/Pose" not in topics(tmp_path)


def test_memory_is_what_may_wait_for_the_disk(one_network, tmp_path):
    (tmp_path / "big.idl").write_text("module Big { @final struct Blob { long number; sequence<octet> bytes; }; };")
    blob = rabit.load_idl(tmp_path / "big.idl").Big.Blob
    with rabit.Node("uav1", record={"folder": str(tmp_path), "free": "0B", "memory": "1MB"}, **one_network) as node:
        wait_until(lambda: node.post("Blob", blob(number=1)) or numbers(tmp_path, "uav1", "uav1/Blob"))
        node.post("Blob", blob(number=2, bytes=bytes(2_000_000)))
        node.post("Blob", blob(number=3))
        wait_until(lambda: 3 in numbers(tmp_path, "uav1", "uav1/Blob"))
    assert set(numbers(tmp_path, "uav1", "uav1/Blob")) == {1, 3}
    losses = [values for name, values in rabit.open(files(tmp_path)[0]).metadata if name == "rabit.losses"]
    assert losses[-1]["uav1/Blob"] == "1"


def catching_up(idl, network, folder, name, **record):
    """A node that records the poses of uav1, later ones and those that it missed."""
    return rabit.Node(name, subscribe=[{"message": "Pose", "type": idl.Uav.Pose, "from": ["uav1"]}],
                      record={"folder": str(folder), "free": "0B", "backfill": ["Pose"], **record}, **network)


def test_backfill_brings_what_was_missed(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {}) as uav1:
        uav1.post_until(lambda: len(numbers(tmp_path, "uav1")) >= 5)
        missed = set(numbers(tmp_path, "uav1"))
        with catching_up(idl, one_network, tmp_path, "ground"):
            wait_until(lambda: missed <= set(numbers(tmp_path, "ground")))


def test_backfill_last_is_how_old_missed_posts_may_be(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {}) as uav1:
        uav1.post_until(lambda: len(numbers(tmp_path, "uav1")) >= 5)
        old = set(numbers(tmp_path, "uav1"))
        uav1.post_for(10)
        with catching_up(idl, one_network, tmp_path, "brief", backfill_last="5s"), \
             catching_up(idl, one_network, tmp_path, "long"):
            uav1.post_until(lambda: old <= set(numbers(tmp_path, "long")) and numbers(tmp_path, "brief"))
    assert not old & set(numbers(tmp_path, "brief"))


def test_backfill_to_names_those_that_may_ask(idl, one_network, tmp_path):
    with Aircraft(idl, one_network, tmp_path, {"backfill_to": ["bas*"]}) as uav1:
        uav1.post_until(lambda: len(numbers(tmp_path, "uav1")) >= 5)
        missed = set(numbers(tmp_path, "uav1"))
        with catching_up(idl, one_network, tmp_path, "ground") as ground, catching_up(idl, one_network, tmp_path, "base"):
            wait_until(lambda: missed <= set(numbers(tmp_path, "base")))
            wait_until(lambda: any(problem.subject == "backfill Pose" for problem in ground.fleet().problems))
    assert not missed & set(numbers(tmp_path, "ground"))


def is_ended(file):
    return file.stat().st_size > 2 * len(END) and file.read_bytes().endswith(END)


def events(file):
    return [message.value["event"] for message in rabit.open(file).messages("uav1/Recorder/Events")]


def test_black_box_messages_are_the_event(idl, one_network, tmp_path):
    box = {"messages": ["Al*"], "after": "1s"}
    with Aircraft(idl, one_network, tmp_path, {"black_box": box}) as uav1:
        uav1.post_for(2, "Pose", "Plan")
        assert not files(tmp_path)
        uav1.post_until(lambda: uav1.is_recorded("uav1/Alarm"), "Pose", "Alarm")
    assert set(events(files(tmp_path)[0])) == {"message uav1/Alarm"}
    assert uav1.is_recorded()


@pytest.mark.parametrize("before", ["1s", "60s"])
def test_black_box_before_and_after_are_the_times_around_the_event(idl, one_network, tmp_path, before):
    box = {"messages": ["Alarm"], "before": before, "after": "1s"}
    with Aircraft(idl, one_network, tmp_path, {"black_box": box}) as uav1:
        uav1.post_until(uav1.is_recorded, "Pose", "Alarm")
        first, = files(tmp_path)
        uav1.post_until(lambda: is_ended(first))
        early = uav1.post()
        uav1.post_for(3)
        event = uav1.post("Pose", "Alarm")
        uav1.post_until(lambda: len(files(tmp_path)) == 2 and is_ended(files(tmp_path)[1]))
        uav1.post_for(1)
    second = rabit.open(files(tmp_path)[1])
    came = {message.value.number: message.log_time for message in second.messages("uav1/Pose")}
    alarm, = second.messages("uav1/Alarm")
    assert alarm.value.number == event and event in came
    assert (early in came) == (before == "60s")
    assert min(came.values()) > alarm.log_time - 1.5e9 or before == "60s"
    assert max(came) > event and max(came.values()) < alarm.log_time + 1.5e9


def test_black_box_queues_are_the_event(idl, one_network, tmp_path):
    box = {"queues": ["Mission*"], "after": "1s"}
    accept = {"MissionControl": [idl.Uav.Goto], "Other": [idl.Uav.Goto]}
    with Aircraft(idl, one_network, tmp_path, {"black_box": box}, accept=accept) as uav1, \
         rabit.Node("ground", **one_network) as ground:
        for queue in ("Other", "MissionControl"):
            assert not files(tmp_path)
            wait_until(lambda queue=queue: ground.send(f"uav1/{queue}", idl.Uav.Goto()).outcome is not rabit.Outcome.REFUSED)
            uav1.node.queue(queue).get(timeout=120)
        wait_until(lambda: uav1.is_recorded("uav1/Recorder/Events"))
    assert events(files(tmp_path)[0]) == ["Uav::Goto of ground in MissionControl"]


@pytest.mark.parametrize("outcomes", [True, False])
def test_black_box_outcomes_are_the_event_unless_they_are_off(idl, one_network, tmp_path, outcomes):
    box = {"messages": ["Alarm"], "outcomes": outcomes}
    with Aircraft(idl, one_network, tmp_path, {"black_box": box}) as uav1:
        assert uav1.node.send("nobody/Queue", idl.Uav.Goto()).outcome is rabit.Outcome.REFUSED
        if outcomes:
            wait_until(lambda: uav1.is_recorded("uav1/Recorder/Events"))
        uav1.post_until(lambda: uav1.is_recorded("uav1/Alarm"), "Alarm")
    refused = [event for event in events(files(tmp_path)[0]) if "nobody/Queue" in event]
    assert len(refused) == (1 if outcomes else 0)


@pytest.mark.parametrize("problems", [True, False])
def test_black_box_problems_are_the_event_if_they_are_on(idl, one_network, tmp_path, problems):
    box = {"messages": ["Alarm"], "problems": problems}
    subscribe = [{"message": "Pose", "type": idl.Uav.Pose, "from": ["uav9"]}]
    with Aircraft(idl, one_network, tmp_path, {"black_box": box}, subscribe=subscribe) as uav1:
        wait_until(lambda: any(problem.subject == "subscribe Pose" for problem in uav1.node.fleet().problems))
        if problems:
            wait_until(lambda: uav1.is_recorded("uav1/Recorder/Events"))
        uav1.post_until(lambda: uav1.is_recorded("uav1/Alarm"), "Alarm")
    told = [event for event in events(files(tmp_path)[0]) if event.startswith("problem ")]
    assert bool(told) == problems
