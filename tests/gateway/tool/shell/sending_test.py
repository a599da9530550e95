#!/usr/bin/env python3
"""Messages sent and posted from the shell.

Usage: sending_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import json
import os
import re
import signal

from two_aircraft import LIMIT, harness, keys, main


def a_message_is_sent_and_its_outcome_is_the_exit_code(rabit):
    done = rabit.run("send", "uav1/MissionControl", "Uav::GoHome", "{}", "--wait", "60")
    assert (done.returncode, done.stdout) == (0, "delivered\n"), done
    assert done.stderr == "rabit: `reply_to` is empty: the receiver tells nobody whether it does what it was sent\n", done
    done = rabit.run("send", "uav1/MissionControl", "Uav::GoHome", '{"reply_to": "ground/Commands"}', "--wait", "60")
    assert (done.returncode, done.stdout, done.stderr) == (0, "delivered\n", ""), done
    (row,), done = rabit.objects("send", "*/MissionControl", "Uav::GoHome", "{}", "--wait", "60")
    assert keys(row) == ["to", "type", "outcome", "reason"] and row["outcome"] == "delivered", row


def lines_of_standard_input_are_sent_each(rabit):
    done = rabit.run("send", "uav2/MissionControl", "Uav::GoHome", "-", "--json", "--wait", "60",
                     text='{"id": 1}\n\n{"ix": 2}\n{"id": 3}\n')
    outcomes = [json.loads(line)["outcome"] for line in done.stdout.splitlines()]
    assert outcomes == ["delivered", "refused", "delivered"], done
    assert done.returncode == 1 and "did you mean `id`?" in done.stderr, done
    assert done.stderr.count("`reply_to` is empty") == 1, done


def the_answer_is_waited_for_and_is_the_exit_code(rabit):
    def go(latitude, *options):
        return rabit.run("send", "uav1/MissionControl", "Uav::Goto", json.dumps({"latitude_deg": latitude}),
                         "--reply", "Uav::CommandAck", *options, "--wait", "60")
    idl = ("--idl", str(harness.ROOT / "idl/messages/uav.idl"))
    done = go(91, *idl)
    assert (done.returncode, done.stderr) == (0, ""), done
    outcome, answer = done.stdout.splitlines()
    assert outcome == "delivered" and json.loads(answer)["stage"] == "COMMAND_DECLINED", done
    assert json.loads(answer)["id"] > 0 and json.loads(answer)["reason"], done
    done = go(91, *idl, "--expect", '{"stage": "COMMAND_ACCEPTED"}', "--json")
    row = json.loads(done.stdout)
    assert done.returncode == 1 and row["outcome"] == "delivered", done
    assert row["reason"] == "an answer is not as expected" and row["answers"][0]["node"] == "uav1", row
    done = go(91, *idl, "--expect", '{"stages": "COMMAND_ACCEPTED"}')
    assert done.returncode == 2 and "did you mean `stage`?" in done.stderr and done.stdout == "", done


def an_answer_that_does_not_come_is_told(rabit):
    idl = str(harness.ROOT / "idl/messages/uav.idl")
    # An aircraft sends no answer of that type.
    done = rabit.run("send", "uav1/MissionControl", "Uav::GoHome", "{}", "--reply", "Uav::Validation", "--idl", idl, "--wait", "8")
    assert done.returncode == 1 and done.stdout == "delivered\n", done
    assert done.stderr == "rabit: 1 of 1 answers did not come in time\n", done
    done = rabit.run("send", "uav1/MissionControl", "Uav::TargetReport", "{}", "--reply", "Uav::Validation", "--idl", idl)
    assert done.returncode == 1 and "has no text `reply_to`" in done.stderr, done


def what_cannot_be_sent_is_told_with_the_nearest_right_word(rabit):
    for arguments, reason in ((("uav1/MissionControl", "Uav::GoHom", "{}"), "did you mean `Uav::GoHome`?"),
                              (("uav1/MissionContro", "Uav::GoHome", "{}"), "did you mean `MissionControl`?"),
                              (("uaw1/MissionControl", "Uav::GoHome", "{}"), "did you mean `uav1`?"),
                              (("uav1/MissionControl", "Uav::GoHome", "{"), "")):
        done = rabit.run_until_heard("send", *arguments, reason=reason)
        assert done.returncode == 1 and reason in done.stderr and done.stderr.count("\n") == 1, done
    assert rabit.run("send", "MissionControl", "Uav::GoHome", "{}").returncode == 2


def a_message_is_posted_as_a_node_of_the_given_name(rabit):
    with harness.Processes() as processes:
        post = processes.start(rabit.argv("post", "uav9/Pose", "Uav::Pose", '{"latitude_deg": 12.5}', "--rate", "10",
                                          "--qos", "telemetry", "--wait", "10"))
        part = rabit.run("echo", "uav9/Pose", "--once", "--field", "latitude_deg", "--wait", "60")
        assert (part.returncode, part.stdout) == (0, "12.5\n"), part
        os.kill(post.pid, signal.SIGINT)
        assert post.exit_code(LIMIT) == 0, post.lines
        assert re.match(r"[1-9]\d* posts?, [1-9]\d* readers?$", post.lines[-1][1]), post.lines


def the_result_of_a_post_is_an_object_for_scripts(rabit):
    (row,), done = rabit.objects("post", "uav8/Nobody", "Uav::Pose", "{}", "--for", "0.1", "--wait", "4")
    assert done.returncode == 1, done
    assert row == {"node": "uav8", "message": "Nobody", "posts": 1, "readers": 0}, row


def a_post_of_another_type_than_the_readers_want_is_told(rabit):
    reason = "subscribers of `Pose` want `Uav::Pose`, not `Uav::Goto`"
    done = rabit.run_until_heard("post", "uav7/Pose", "Uav::Goto", "{}", "--for", "0.5", reason=reason)
    assert done.returncode == 1 and reason in done.stderr, done


def what_cannot_be_posted_is_told(rabit):
    done = rabit.run("post", "uav1/Pose", "Uav::Pose", "{}", "--wait", "60")
    assert done.returncode == 1 and "there is a node `uav1`" in done.stderr and done.stdout == "", done
    for arguments, code, reason in ((("uav9/Pose", "Uav::Poze", "{}"), 1, "did you mean `Uav::Pose`?"),
                                    (("uav9/Pose", "Uav::Pose", '{"latitude": 1}'), 1, "did you mean `latitude_deg`?"),
                                    (("Pose", "Uav::Pose", "{}"), 2, "expected NODE/MESSAGE")):
        done = rabit.run("post", *arguments, "--wait", "10")
        assert done.returncode == code and reason in done.stderr and done.stdout == "", done


TESTS = [a_message_is_sent_and_its_outcome_is_the_exit_code, the_answer_is_waited_for_and_is_the_exit_code,
         an_answer_that_does_not_come_is_told, lines_of_standard_input_are_sent_each,
         what_cannot_be_sent_is_told_with_the_nearest_right_word, a_message_is_posted_as_a_node_of_the_given_name,
         the_result_of_a_post_is_an_object_for_scripts,
         what_cannot_be_posted_is_told, a_post_of_another_type_than_the_readers_want_is_told]


if __name__ == "__main__":
    main(TESTS)
