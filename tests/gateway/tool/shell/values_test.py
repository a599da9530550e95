#!/usr/bin/env python3
"""The values of messages from the shell: shown, measured, and followed until somebody ends it.

Usage: values_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import os
import re
import signal
import subprocess

from two_aircraft import LIMIT, SWARM, harness, keys, main


def a_value_is_echoed_as_text_as_json_and_in_part(rabit):
    done = rabit.run("echo", "uav1/Pose", "--once", "--wait", "30")
    assert done.returncode == 0 and re.match(r"uav1/Pose  age \d+\.\d{3} s  Uav::Pose \{latitude_deg: ", done.stdout)
    assert len(done.stdout.splitlines()) == 1
    (value,), _ = rabit.objects("echo", "uav2/Pose", "--once", "--wait", "30")
    assert keys(value) == ["node", "message", "type", "age_s", "posted_gps_s", "value"]
    assert value["node"] == "uav2" and 0 <= value["age_s"] < LIMIT and 40 < value["value"]["latitude_deg"] < 60
    part = rabit.run("echo", "uav1/Pose", "--once", "--field", "latitude_deg", "--wait", "30")
    assert 40 < float(part.stdout) < 60
    wrong = rabit.run("echo", "uav1/Pose", "--once", "--field", "latitude_dex", "--wait", "30")
    assert wrong.returncode == 1 and "did you mean `latitude_deg`?" in wrong.stderr


def a_state_that_was_posted_before_is_echoed_at_once(rabit):
    (value,), done = rabit.objects("echo", "uav1/MissionState", "--once", "--wait", "30")
    assert done.returncode == 0 and value["value"]["mode"].startswith("MISSION_")


def values_of_several_nodes_are_echoed_together(rabit):
    with harness.Processes() as processes:
        both = processes.start(rabit.argv("echo", "uav*/Pose", "--wait", "30"))
        for node in ("uav1", "uav2"):
            both.wait_for(lambda text, node=node: text.startswith(node + "/Pose"), LIMIT)
        assert both.terminate() == 0


def rate_size_and_age_of_a_message_are_measured(rabit):
    (rate,), _ = rabit.objects("hz", "uav1/Pose", "--for", "2", "--wait", "30")
    assert keys(rate) == ["node", "message", "values", "rate_hz", "jitter_s", "shortest_s", "longest_s"]
    assert rate["values"] > 2 and 1 < rate["rate_hz"] < 100
    assert rate["shortest_s"] <= 1 / rate["rate_hz"] <= rate["longest_s"]
    (size,), _ = rabit.objects("bytes", "uav1/Pose", "--for", "2", "--wait", "30")
    assert keys(size) == ["node", "message", "values", "bytes", "air_bytes", "air_bytes_per_s"]
    assert 4 < size["bytes"] < size["air_bytes"] < size["air_bytes_per_s"]
    (age,), _ = rabit.objects("age", "uav1/Pose", "--for", "2", "--wait", "30")
    assert keys(age) == ["node", "message", "values", "p50_s", "p90_s", "p99_s", "oldest_s", "uncertainty_s"]
    assert 0 <= age["p50_s"] <= age["p90_s"] <= age["p99_s"] <= age["oldest_s"] < LIMIT
    table = rabit.run("hz", "uav*/Pose", "--for", "2", "--wait", "30")
    assert table.stdout.split()[0] == "NODE" and " Hz" in table.stdout, table


def ctrl_c_ends_it_well(rabit):
    with harness.Processes() as processes:
        waiting = processes.start(rabit.argv("send", "uav1/MissionControl", "Uav::GoHome", "-", "--wait", "30"))
        waiting.tell("{}")
        waiting.wait_for(lambda text: text == "delivered", LIMIT)
        os.kill(waiting.pid, signal.SIGINT)
        assert waiting.exit_code(LIMIT) == 0
        for number in (signal.SIGINT, signal.SIGTERM):
            echo = processes.start(rabit.argv("echo", "uav1/Pose", "--wait", "30"))
            echo.wait_for(lambda text: text.startswith("uav1/Pose"), LIMIT)
            os.kill(echo.pid, number)
            assert echo.exit_code(LIMIT) == 0


def a_pipe_that_is_closed_ends_it_well(rabit):
    with subprocess.Popen(rabit.argv("echo", "uav1/Pose", "--wait", "30"), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE) as echo:
        assert echo.stdout.readline().startswith(b"uav1/Pose")
        echo.stdout.close()
        assert echo.wait(LIMIT) == 0
        assert echo.stderr.read() == b""


def a_node_that_vanishes_meanwhile_is_waited_for_and_what_is_sent_to_it_is_not_delivered(rabit):
    with harness.Processes() as processes:
        gone = processes.start([rabit.uav, "--config", SWARM / "uav.yaml", "--node", "uav7", "--domain", rabit.domain,
                                "--transport", rabit.transport])
        echo = processes.start(rabit.argv("echo", "uav7/Pose", "--wait", "60"))
        send = processes.start(rabit.argv("send", "uav7/MissionControl", "Uav::GoHome", "-", "--expire", "3", "--json",
                                          "--wait", "60"))
        echo.wait_for(lambda text: text.startswith("uav7/Pose"), LIMIT)
        send.tell("{}")
        send.wait_for(lambda text: '"outcome":"delivered"' in text, LIMIT)
        gone.kill()
        send.tell("{}")
        # The sender cannot know whether the message arrived before the node ended.
        send.wait_for(lambda text: '"outcome":"expired"' in text or '"outcome":"in doubt"' in text, LIMIT)
        os.kill(send.pid, signal.SIGINT)
        assert send.exit_code(LIMIT) == 1
        os.kill(echo.pid, signal.SIGINT)
        assert echo.exit_code(LIMIT) == 0, echo.lines


def no_text_of_a_stranger_commands_the_terminal(rabit):
    hostile = "\\u001b[2J\\u0007\\u009b31m\\r\\u001b]0;x\\u0007"
    with harness.Processes() as processes:
        post = processes.start(rabit.argv("post", "evil/MissionState", "Uav::MissionState", '{"text": "' + hostile + '"}',
                                          "--rate", "5", "--wait", "10"))
        for arguments in (("echo", "evil/MissionState", "--once"), ("echo", "evil/MissionState", "--once", "--json"),
                          ("echo", "evil/MissionState", "--once", "--field", "text"), ("nodes",), ("messages",)):
            done = rabit.run(*arguments, "--wait", "60" if arguments[0] == "echo" else "30")
            assert done.returncode in (0, 1) and done.stdout, done
            text = done.stdout + done.stderr
            assert all(" " <= c <= "~" or c == "\n" for c in text), (arguments, text)
        os.kill(post.pid, signal.SIGINT)
        assert post.exit_code(LIMIT) in (0, 1), post.lines
    for bad in ("uav1/Po\x1b[2Jse", "\x1b]0;x\x07/Pose"):
        done = rabit.run("echo", bad, "--wait", "2")
        assert done.returncode != 0 and "\x1b" not in done.stdout + done.stderr, done


TESTS = [a_value_is_echoed_as_text_as_json_and_in_part, a_state_that_was_posted_before_is_echoed_at_once,
         values_of_several_nodes_are_echoed_together, rate_size_and_age_of_a_message_are_measured, ctrl_c_ends_it_well,
         a_pipe_that_is_closed_ends_it_well,
         a_node_that_vanishes_meanwhile_is_waited_for_and_what_is_sent_to_it_is_not_delivered,
         no_text_of_a_stranger_commands_the_terminal]


if __name__ == "__main__":
    main(TESTS)
