#!/usr/bin/env python3
"""A node that records itself, and `rabit play` of that from the shell, on each DDS implementation.

Usage: play_test.py RABIT SENSOR TRANSPORT[,TRANSPORT]... [TEST]..."""

import fcntl
import json
import os
import pathlib
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import termios
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 300
READINGS = 4  # at least


class Setup:
    """The programs, a recording of the node `sensor`, and the network in which that is played."""

    def __init__(self, rabit, sensor, transport, folder):
        self.rabit = rabit
        self.network = ["--domain", str(harness.domain()), "--transport", transport]
        self._record(sensor, transport, pathlib.Path(folder))

    def _record(self, sensor, transport, folder):
        config = folder / "sensor.yaml"
        config.write_text(f"node: sensor\ndomain: {harness.domain()}\ntransport: {transport}\ninterfaces: [127.0.0.1]\n"
                          "publish:\n  - {message: Reading, type: TwoNodes::Reading}\n"
                          "accept:\n  - {queue: Sensor, types: [TwoNodes::Calibration]}\n"
                          f"record: {{folder: {folder}/recorded, free: 0B}}\n")
        outside = subprocess.Popen(self.argv("record", "sensor/Reading", "--to", folder / "outside", "--wait", LIMIT,
                                             "--interface", "127.0.0.1"), stdout=subprocess.DEVNULL)
        with subprocess.Popen([sensor, "--config", str(config)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as node:
            try:
                sent = self.run("send", "sensor/Sensor", "TwoNodes::Calibration", '{"offset_celsius": 1}',
                                "--interface", "127.0.0.1", "--wait", "60", "--node", "pilot")
                assert sent.stdout == "delivered\n", sent
                harness.until(lambda: self._count(folder / "recorded", "sensor/Reading") >= READINGS)
                harness.until(lambda: self._count(folder / "outside", "sensor/Reading") >= 2)
            finally:
                node.send_signal(signal.SIGTERM)
        # The recording shows several times that the node is gone.
        known = self._count(folder / "outside", "/Gateway/Fleet")
        harness.until(lambda: self._count(folder / "outside", "/Gateway/Fleet") >= known + 5)
        outside.send_signal(signal.SIGINT)
        assert outside.wait(LIMIT) == 0
        self.file, = folder.glob("recorded/*.mcap")
        self.from_outside, = folder.glob("outside/*.mcap")

    def _count(self, folder, topic):
        """How many messages of topics that end so are in the only file of the folder."""
        files = list(folder.glob("*.mcap"))
        if not files:
            return 0
        about = json.loads(subprocess.run([self.rabit, "info", "--json", str(files[0])], capture_output=True,
                                          text=True, timeout=LIMIT, check=False).stdout)
        return sum(row["messages"] for row in about["topics"] if row["topic"].endswith(topic))

    def run(self, command, *arguments):
        return subprocess.run(self.argv(command, *arguments), capture_output=True, text=True, timeout=LIMIT,
                              stdin=subprocess.DEVNULL, check=False)

    def argv(self, command, *arguments):
        return [self.rabit, command, *[str(one) for one in arguments], *self.network]

    def play(self, *arguments):
        """What it says at the end, and the program's result."""
        done = self.run("play", self.file, "--json", *arguments)
        return (json.loads(done.stdout) if done.stdout else None), done

    def echo(self, processes, what):
        return processes.start(self.argv("echo", what, "--json", "--interface", "127.0.0.1", "--wait", LIMIT))


def values(echo, count):
    """The first values that it has written."""
    def enough(_):
        return sum(text.startswith("{") for _, text in echo.lines) >= count
    echo.wait_for(enough, LIMIT)
    return [json.loads(text) for _, text in echo.lines if text.startswith("{")]


def the_recorded_values_come_again_in_their_order(setup):
    began = time.monotonic()
    with harness.Processes() as processes:
        echo = setup.echo(processes, "replay.sensor/Reading")
        told, done = setup.play("--to", "3.5")
        assert done.returncode == 0 and re.fullmatch(r"rabit: plays 1 node for 3\.\d+ s, in domain \d+ on .*\n", done.stderr), done
        assert told["nodes"] == ["replay.sensor"] and told["messages"] >= 3, told
        came = values(echo, told["messages"])
    assert [row["value"]["number"] for row in came] == list(range(1, told["messages"] + 1)), came
    assert {row["node"] for row in came} == {"replay.sensor"}, came
    # Of the replay, not of the recording.
    assert all(0 <= row["age_s"] < time.monotonic() - began for row in came), came
    posted = [row["posted_gps_s"] for row in came]
    assert posted == sorted(set(posted)) and posted[-1] - posted[0] < time.monotonic() - began, came


def as_fast_as_it_goes_none_is_left_out(setup):
    with harness.Processes() as processes:
        echo = setup.echo(processes, "replay.sensor/Reading")
        told, done = setup.play("--rate", "max")
        assert done.returncode == 0, done
        came = values(echo, told["messages"] - told["replaced"])
    assert told["messages"] >= READINGS and told["replaced"] == 0, told
    assert [row["value"]["number"] for row in came] == list(range(1, told["messages"] + 1)), came


def from_a_moment_on_what_was_posted_before_is_there_as_old_as_it_was(setup):
    known = json.loads(subprocess.run([setup.rabit, "knew", "--json", str(setup.file), "sensor", "sensor/Reading", "--at", "2.6"],
                                      capture_output=True, text=True, timeout=LIMIT, check=True).stdout)
    posted = 2.6 - known["age_s"]
    began = time.monotonic()
    with harness.Processes() as processes:
        echo = setup.echo(processes, "replay.sensor/Reading")
        told, done = setup.play("--from", f"{posted + 0.4:.3f}", "--to", f"{posted + 0.5:.3f}")
        assert done.returncode == 0 and told["restored"] == 1 and told["messages"] == 0, (told, done)
        came = values(echo, 1)
    assert came[0]["value"]["number"] == known["value"]["number"], (known, came)
    assert 0.39 < came[0]["age_s"] < 0.5 + time.monotonic() - began, came


def it_is_a_node_that_says_that_it_replays(setup):
    with harness.Processes() as processes:
        play = processes.start(setup.argv("play", setup.file, "--rate", "0.1"))

        def listed():
            rows = map(json.loads, setup.run("nodes", "--json", "--interface", "127.0.0.1", "--wait", "4").stdout.splitlines())
            return next((row for row in rows if row.get("node") == "replay.sensor" and row["publishes"]), None)

        node = harness.until(listed)
        assert node["state"] == "UP" and node["replay"] is True, node
        assert [(row["message"], row["qos"]) for row in node["publishes"]] == [("Reading", "state")], node
        os.kill(play.pid, signal.SIGINT)
        assert play.exit_code(LIMIT) == 0, play.lines


def a_node_that_left_leaves_when_it_did_and_comes_again_in_the_next_round(setup):
    with harness.Processes() as processes:
        nodes = processes.start(setup.argv("nodes", "--watch", "--json", "--interface", "127.0.0.1"))
        play = processes.start(setup.argv("play", setup.from_outside, "--loop", "--rate", "1"))

        def lives():
            rows = [json.loads(text) for _, text in list(nodes.lines) if text.startswith("{")]
            rows = [row for row in rows if row.get("node") == "replay.sensor" and "incarnation" in row]
            return [(row["incarnation"], row["state"], row["reason"]) for row in rows]

        nodes.wait_for(lambda _: len({life for life, state, _ in lives() if state == "UP"}) >= 2, LIMIT)
        assert play.running(), play.lines
        first, = {life for life, state, reason in lives() if reason == "left"}
        assert (first, "UP", "") in lives(), lives()


def a_name_that_is_taken_is_not_played(setup):
    idl = str(harness.ROOT / "examples/two_nodes/two_nodes.idl")
    with harness.Processes() as processes:
        processes.start(setup.argv("post", "live/Reading", "TwoNodes::Reading", "{}", "--idl", idl, "--rate", "1",
                                   "--interface", "127.0.0.1"))
        harness.until(lambda: '"live"' in setup.run("nodes", "--json", "--interface", "127.0.0.1").stdout)
        told, done = setup.play("--rename", "sensor=live", "--rate", "max", "--wait", "20")
        assert done.returncode == 1 and told is None, done
        assert done.stderr == ("rabit: there is a node `live`; two of one name would disturb each other "
                               "(--rename)\n"), done


def queue_messages_go_only_to_queues_that_are_named(setup):
    told, done = setup.play("--rate", "max", "--wait", "1")
    assert told["queue_messages"] == 0 and told["nodes"] == ["replay.sensor"], (told, done)
    told, done = setup.play("--rate", "max", "--wait", "1", "--queues", "sensor/*", "--include", "x/y")
    assert told["queue_messages"] == told["undelivered"] == 1 and told["messages"] == 0, (told, done)
    assert told["nodes"] == ["replay.pilot"] and done.returncode == 1, (told, done)


def what_cannot_be_played_is_told_in_a_line(setup):
    for arguments, code, reason in ((("--include", "uav1/*"), 1, "nothing in it that can be played"),
                                    (("--rename", "sensor"), 2, "expected OLD=NEW"),
                                    (("--rename", "sensor=" + 70 * "x"), 2, "renames no node"),
                                    (("--from", "1e9"), 2, "is no time; expected seconds"),
                                    (("--from", "99999"), 2, "nothing was recorded then"),
                                    (("--from", "2", "--to", "1"), 2, "nothing was recorded then"),
                                    (("--start-paused",), 2, "standard input is no terminal"),
                                    (("--rate", "0.01"), 2, "`0.01` is no rate; expected 0.1 to 100, or max"),
                                    (("/no/such/file",), 1, "No such file"),
                                    ((__file__,), 0, "this is no MCAP file")):
        told, done = setup.play("--rate", "max", "--wait", "0.1", *arguments)
        assert done.returncode == code and reason in done.stderr, (arguments, done)
        assert code == 0 or told is None, (arguments, done)


def keys_of_a_terminal_pause_step_seek_and_end_it(setup):
    master, slave = pty.openpty()
    with subprocess.Popen(setup.argv("play", setup.file, "--start-paused", "--wait", "1"), stdin=slave,
                          stdout=subprocess.PIPE, stderr=slave, text=True,
                          preexec_fn=lambda: take_terminal(slave)) as play:
        os.close(slave)
        said = ""

        def until(text):
            nonlocal said
            while text not in said:
                assert select.select([master], [], [], LIMIT)[0], said
                said += os.read(master, 1000).decode()
            said = said[said.index(text) + len(text):]

        until("space pauses")
        os.write(master, b"s")
        until("paused at 0.0 s of ")
        os.write(master, b".")
        until("at ")
        os.write(master, b",")
        until("at 0.0 s of ")
        os.write(master, b" ")
        until("goes on at 0.0 s of ")
        os.write(master, b" ")
        until("paused at ")
        os.write(master, b"q")
        out, _ = play.communicate(timeout=LIMIT)
        assert play.returncode == 0 and " of 1 node" in out, (out, said)
    os.close(master)


def take_terminal(slave):
    os.setsid()
    fcntl.ioctl(slave, termios.TIOCSCTTY, 0)


TESTS = [the_recorded_values_come_again_in_their_order, as_fast_as_it_goes_none_is_left_out,
         from_a_moment_on_what_was_posted_before_is_there_as_old_as_it_was, it_is_a_node_that_says_that_it_replays,
         a_node_that_left_leaves_when_it_did_and_comes_again_in_the_next_round, a_name_that_is_taken_is_not_played, queue_messages_go_only_to_queues_that_are_named,
         what_cannot_be_played_is_told_in_a_line, keys_of_a_terminal_pause_step_seek_and_end_it]


def main():
    harness.enter_namespace()
    rabit, sensor, transports = sys.argv[1], sys.argv[2], sys.argv[3].split(",")
    failed = []
    for transport in transports:
        with tempfile.TemporaryDirectory() as folder:
            setup = Setup(rabit, sensor, transport, folder)
            for test in [test for test in TESTS if not sys.argv[4:] or test.__name__ in sys.argv[4:]]:
                try:
                    test(setup)
                    print(f"ok      {transport} {test.__name__}", flush=True)
                except Exception as error:  # pylint: disable=broad-except
                    failed.append(test.__name__)
                    print(f"FAILED  {transport} {test.__name__}: {type(error).__name__} {error}", flush=True)
    sys.exit(f"{len(failed)} failed" if failed else 0)


if __name__ == "__main__":
    main()
