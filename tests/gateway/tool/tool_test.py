#!/usr/bin/env python3
"""The program `rabit` from the shell, against real nodes: two aircraft, one on each DDS implementation.

Usage: tool_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402

# Only keeps a broken program from hanging.
LIMIT = 120
HASH = re.compile(r"^[0-9a-f]{16}$")


class Rabit:
    """Runs the program as one who types it."""

    def __init__(self, program, transport, domain, uav=None):
        self.program = program
        self.transport = transport
        self.domain = domain
        self.uav = uav
        self._network = ["--interface", "127.0.0.1", "--domain", str(domain), "--transport", transport]

    def argv(self, command, *arguments):
        return [self.program, command, *self._network, *arguments]

    def run(self, command, *arguments, text=None):
        return subprocess.run(self.argv(command, *arguments), input=text, capture_output=True, text=True,
                              timeout=LIMIT, check=False)

    def objects(self, command, *arguments):
        done = self.run(command, "--json", *arguments)
        return [json.loads(line) for line in done.stdout.splitlines()], done


def keys(thing):
    return list(thing.keys())


def nodes_are_listed_with_what_they_have(rabit):
    def both():
        listed, done = rabit.objects("nodes", "--wait", "10")
        rows = {row["node"]: row for row in listed if "node" in row and "problem" not in row}
        return (rows, done) if {"uav1", "uav2"} <= set(rows) and done.returncode == 0 else None

    rows, done = harness.until(both)
    assert set(rows) == {"uav1", "uav2"}, "a tool is listed"
    assert done.stderr == "", done.stderr
    row = rows["uav1"]
    assert keys(row) == ["node", "state", "reason", "incarnation", "last_heard_s", "round_trip_s", "delivery_rate",
                         "publishes", "accepts", "replay"], keys(row)
    assert row["replay"] is False
    assert row["state"] == "UP" and 0 < row["round_trip_s"] < LIMIT
    pose = next(item for item in row["publishes"] if item["message"] == "Pose")
    assert keys(pose) == ["message", "type", "qos", "definition"]
    assert pose["type"] == "Uav::Pose" and pose["qos"] == "telemetry" and HASH.match(pose["definition"])
    queue = next(item for item in row["accepts"] if item["queue"] == "MissionControl")
    assert keys(queue) == ["queue", "types", "from"] and queue["from"] == ["*"]
    assert "Uav::Goto" in [item["type"] for item in queue["types"]]


def nodes_is_a_table_for_people(rabit):
    done = harness.until(lambda: (lambda d: d if "uav1" in d.stdout and "uav2" in d.stdout else None)(rabit.run("nodes")))
    lines = done.stdout.splitlines()
    assert lines[0].split() == ["NODE", "STATE", "HEARD", "ROUND", "TRIP", "DELIVERY", "PUBLISHES", "ACCEPTS"], lines
    assert "\x1b" not in done.stdout, "escape sequences in a pipe"


def messages_are_listed_with_their_types_and_who_publishes_and_reads_them(rabit):
    aircraft = ["uav1", "uav2"]

    def both():
        listed, done = rabit.objects("messages", "--wait", "10")
        rows = {row["message"]: row for row in listed}
        poses = rows.get("Pose")
        return rows if done.returncode == 0 and poses and poses["publishers"] == poses["subscribers"] == aircraft else None

    rows = harness.until(both)
    assert keys(rows["Pose"]) == ["message", "type", "qos", "definition", "publishers", "subscribers", "other_subscribers",
                                  "rate_hz"]
    assert rows["Pose"]["other_subscribers"] == 0
    assert rows["Health"]["publishers"] == aircraft and rows["Health"]["subscribers"] == [], rows["Health"]
    assert "MissionState" in rows


def the_idl_of_a_type_is_had_by_its_name_and_by_a_messages_name(rabit):
    by_type = rabit.run("type", "Uav::Pose", "--wait", "30")
    by_message = rabit.run("type", "Pose", "--wait", "30")
    assert by_type.returncode == by_message.returncode == 0, by_type.stderr + by_message.stderr
    assert by_type.stdout == by_message.stdout
    assert "double latitude_deg;" in by_type.stdout
    (row,), _ = rabit.objects("type", "Uav::Goto", "--wait", "30")
    assert keys(row) == ["type", "definition", "nodes", "idl"] and "struct Goto" in row["idl"]


def a_name_that_is_wrong_is_answered_with_the_nearest(rabit):
    for arguments, hint in ((("type", "Uav::Poze"), "did you mean `Uav::Pose`?"),
                            (("echo", "uav1/Poze"), "did you mean `Pose`?"),
                            (("echo", "uaw1/Pose"), "did you mean `uav1`?")):
        done = rabit.run(*arguments, "--wait", "4")
        assert done.returncode == 1 and hint in done.stderr and done.stdout == "", done


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


def a_message_is_sent_and_its_outcome_is_the_exit_code(rabit):
    done = rabit.run("send", "uav1/MissionControl", "Uav::GoHome", "{}", "--wait", "60")
    assert (done.returncode, done.stdout, done.stderr) == (0, "delivered\n", ""), done
    (row,), done = rabit.objects("send", "*/MissionControl", "Uav::GoHome", "{}", "--wait", "60")
    assert keys(row) == ["to", "type", "outcome", "reason"] and row["outcome"] == "delivered", row


def lines_of_standard_input_are_sent_each(rabit):
    done = rabit.run("send", "uav2/MissionControl", "Uav::GoHome", "-", "--json", "--wait", "60",
                     text='{"id": 1}\n\n{"ix": 2}\n{"id": 3}\n')
    outcomes = [json.loads(line)["outcome"] for line in done.stdout.splitlines()]
    assert outcomes == ["delivered", "refused", "delivered"], done
    assert done.returncode == 1 and "did you mean `id`?" in done.stderr, done


def what_cannot_be_sent_is_told_with_the_nearest_right_word(rabit):
    for arguments, reason in ((("uav1/MissionControl", "Uav::GoHom", "{}"), "did you mean `Uav::GoHome`?"),
                              (("uav1/MissionContro", "Uav::GoHome", "{}"), "did you mean `MissionControl`?"),
                              (("uaw1/MissionControl", "Uav::GoHome", "{}"), "did you mean `uav1`?"),
                              (("uav1/MissionControl", "Uav::GoHome", "{"), "")):
        done = rabit.run("send", *arguments, "--wait", "4")
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
        assert re.match(r"\d+ posts, [1-9]\d* readers?$", post.lines[-1][1]), post.lines


def what_cannot_be_posted_is_told(rabit):
    done = rabit.run("post", "uav1/Pose", "Uav::Pose", "{}", "--wait", "60")
    assert done.returncode == 1 and "there is a node `uav1`" in done.stderr and done.stdout == "", done
    for arguments, code, reason in ((("uav9/Pose", "Uav::Poze", "{}"), 1, "did you mean `Uav::Pose`?"),
                                    (("uav9/Pose", "Uav::Pose", '{"latitude": 1}'), 1, "did you mean `latitude_deg`?"),
                                    (("Pose", "Uav::Pose", "{}"), 2, "expected NODE/MESSAGE")):
        done = rabit.run("post", *arguments, "--wait", "10")
        assert done.returncode == code and reason in done.stderr and done.stdout == "", done


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


def wrong_usage_is_2(rabit):
    for arguments in (["nodes", "--interfase", "lo"], ["nose"], [], ["echo"], ["nodes", "--domain", "233"],
                      ["nodes", "--transport", "fastdss"], ["nodes", "--config", "/no/such/file"], ["check"],
                      ["check", "/no/such/file"], ["check", "--rate", "Pose", __file__]):
        done = subprocess.run([rabit.program, *arguments], capture_output=True, text=True, timeout=LIMIT,
                              check=False)
        assert done.returncode == 2, (arguments, done)
        assert done.stdout == "" and done.stderr != "", (arguments, done)


def nobody_in_the_domain_is_3(rabit):
    for command in (["nodes"], ["messages"], ["type", "X"], ["echo", "X"]):
        done = Rabit(rabit.program, rabit.transport, harness.domain() + 1).run(*command, "--wait", "1")
        assert done.returncode == 3 and "nobody was heard in domain" in done.stderr and done.stdout == "", done


def viewers_elsewhere_are_served_only_by_an_option_that_says_what_it_means(rabit):
    done = rabit.run("foxglove", "--listen", "0.0.0.0", "--port", "0")
    assert done.returncode == 2 and done.stdout == "", done
    assert "would see everything" in done.stderr and "--open-to-everybody-on-the-network" in done.stderr, done


def a_configuration_of_a_node_serves_for_its_network_alone(rabit):
    done = subprocess.run([rabit.program, "echo", "uav1/Pose", "--once", "--wait", "30",
                           "--config", str(harness.ROOT / "examples/swarm/uav.yaml"),
                           "--domain", str(harness.domain())], capture_output=True, text=True, timeout=LIMIT,
                          check=False)
    assert done.returncode == 0, done.stderr


SWARM = harness.ROOT / "examples/swarm"
FLEET = [f"uav1,uav2={SWARM}/uav.yaml", f"uav1.vision,uav2.vision={SWARM}/vision.yaml",
         str(harness.ROOT / "examples/ground_station/ground.yaml")]


def check(rabit, *arguments):
    return subprocess.run([rabit.program, "check", *arguments], capture_output=True, text=True, timeout=LIMIT,
                          check=False)


def configurations_of_a_fleet_are_checked_against_each_other(rabit):
    good = check(rabit, *FLEET)
    assert good.returncode == 0 and good.stderr == "" and good.stdout.startswith("NODE"), good
    with tempfile.TemporaryDirectory() as folder:
        wrong = pathlib.Path(folder) / "ground.yaml"
        wrong.write_text((harness.ROOT / "examples/ground_station/ground.yaml").read_text()
                         .replace("message: Health", "message: Helth"))
        done = check(rabit, *FLEET[:2], str(wrong))
        assert done.returncode == 1, done
        assert f"{wrong}:11: subscribe Helth: nobody publishes it; did you mean `Health`?\n" in done.stdout, done
        wrong.write_text("node: ground\ndomian: 7\n")
        done = check(rabit, *FLEET[:2], str(wrong))
        assert done.returncode == 1, done
        assert done.stdout.startswith(f"{wrong}:2: unknown key `domian` in the configuration; did you mean `domain`?\n")


def what_a_fleet_puts_on_the_air_is_checked_against_its_budgets(rabit):
    idl = str(harness.ROOT / "idl/messages/uav.idl")
    with tempfile.TemporaryDirectory() as folder:
        thin = pathlib.Path(folder) / "uav.yaml"
        thin.write_text((SWARM / "uav.yaml").read_text() + "radio:\n  budget: 1kB/s\n")
        fleet = [f"uav1,uav2={thin}", *FLEET[1:], "--idl", idl, "--json"]
        done = check(rabit, *fleet, "--rate", "Pose=5")
        assert done.returncode == 0, done
        plan = next(row for row in map(json.loads, done.stdout.splitlines()) if row.get("node") == "uav1")
        assert keys(plan) == ["node", "file", "air_bytes_per_s", "budget_bytes_per_s", "not_known", "items"], plan
        assert plan["budget_bytes_per_s"] == 1000 and 740 < plan["air_bytes_per_s"] < 1000, plan
        assert "rate of Pose" not in plan["not_known"] and "rate and size of Findings" in plan["not_known"], plan
        pose = next(item for item in plan["items"] if item["what"] == "Pose")
        assert pose == {"what": "Pose", "bytes": 148, "rate_hz": 5, "copies": 1, "bytes_per_s": 740}, pose
        done = check(rabit, *fleet, "--rate", "Pose=10")
        problem = json.loads(done.stdout.splitlines()[0])
        assert done.returncode == 1 and keys(problem) == ["problem", "file", "line", "nodes"], done
        assert problem["line"] == len(thin.read_text().splitlines()) and problem["nodes"] == ["uav1", "uav2"], problem
        assert "1000 B/s" in problem["problem"] and "Pose" in problem["problem"], problem


def how_often_all_messages_come_is_measured_together(rabit):
    listed, done = rabit.objects("messages", "--for", "3", "--wait", "10")
    rates = {row["message"]: row["rate_hz"] for row in listed}
    assert done.returncode == 0 and 2 < rates["Pose"] < 200, done
    table = rabit.run("messages", "--for", "1")
    assert table.stdout.split("\n")[0].split() == "MESSAGE TYPE QOS RATE PUBLISHED BY READ BY".split(), table


def a_doctor_finds_nothing_wrong_with_a_fleet_that_is_well(rabit):
    def well():
        findings, done = rabit.objects("doctor", "--wait", "4")
        return findings if done.returncode == 0 else None

    findings = harness.until(well)
    assert all(keys(finding) == ["level", "subject", "text", "advice"] for finding in findings), findings
    said = {finding["subject"]: finding["text"] for finding in findings}
    assert {"interface lo", "nodes", "clocks", "multicast on lo"} <= set(said), findings
    assert {"uav1", "uav2"} <= set(said["nodes"].split()), said
    assert "answered by 127.0.0.1" in said["multicast on lo"], said


def a_doctor_tells_of_the_domain_that_the_others_are_in(rabit):
    other = (rabit.domain + 100) % 200

    def named():
        done = Rabit(rabit.program, rabit.transport, other).run("doctor", "--wait", "4")
        assert done.returncode == 3 and "nobody was heard" in done.stderr, done
        return re.search(rf"^! domain {rabit.domain}: .*uav1.*--domain {rabit.domain}", done.stdout, re.MULTILINE)
    harness.until(named)


def a_doctor_tells_of_two_nodes_of_one_name_and_of_an_interface_that_is_not_there(rabit):
    with harness.Processes() as processes:
        for _ in range(2):
            processes.start([rabit.uav, "--config", SWARM / "uav.yaml", "--node", "twin", "--domain", rabit.domain,
                             "--transport", rabit.transport])

        def twice():
            done = rabit.run("doctor", "--wait", "6")
            return "! node twin: two live nodes have this name. Do: give one of them another one" in done.stdout
        harness.until(twice)
    done = subprocess.run([rabit.program, "doctor", "--interface", "nosuch0", "--wait", "1"], capture_output=True,
                          text=True, timeout=LIMIT, check=False)
    assert done.returncode == 3 and "! interface nosuch0: this machine has none. Do: name one of " in done.stdout, done


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
        # Whether it got there before the end came nobody can know.
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
            done = rabit.run(*arguments, "--wait", "60" if arguments[0] == "echo" else "3")
            assert done.returncode in (0, 1) and done.stdout, done
            text = done.stdout + done.stderr
            assert all(" " <= c <= "~" or c == "\n" for c in text), (arguments, text)
        os.kill(post.pid, signal.SIGINT)
        assert post.exit_code(LIMIT) in (0, 1), post.lines
    for bad in ("uav1/Po\x1b[2Jse", "\x1b]0;x\x07/Pose"):
        done = rabit.run("echo", bad, "--wait", "2")
        assert done.returncode != 0 and "\x1b" not in done.stdout + done.stderr, done


COMPLETION = harness.ROOT / "gateway/tool/completion"
# Each reads the project's file, and then does what it does when one types the words and presses the tabulator.
SHELLS = {
    "bash": ["bash", "-c", """
        . /usr/share/bash-completion/bash_completion; . "$0/rabit.bash"
        COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}
        _rabit; printf '%s\n' "${COMPREPLY[@]}" """],
    "zsh": ["zsh", "-f", "-c", """
        compadd() { print -l -- "${found[@]}" }
        completion=$0/_rabit; words=("$@"); CURRENT=$#; . "$completion" """],
    "fish": ["fish", "--no-config", "-c", """
        source "$argv[1]/rabit.fish"; complete -C (string join ' ' -- $argv[2..-1])"""],
}


def completed(shell, rabit, command, *words):
    """What that shell offers for the last word."""
    line = rabit.argv(command, *words) if words else [rabit.program, command]
    done = subprocess.run([*SHELLS[shell], COMPLETION, *line], capture_output=True, text=True, timeout=LIMIT, check=False)
    return [offer.split("\t")[0] for offer in done.stdout.splitlines() if offer]


def shells_complete_commands_and_options(rabit):
    for shell in SHELLS:
        assert completed(shell, rabit, "e") == ["echo"], shell
        assert completed(shell, rabit, "post", "--q") == ["--qos"], shell
        assert completed(shell, rabit, "nodes", "--transport", "c") == ["cyclonedds"], shell


def shells_complete_what_the_fleet_has(rabit):
    for shell in SHELLS:
        def offers(*words, shell=shell):
            return completed(shell, rabit, *words)

        def poses():
            return set(offers("echo", "uav")) >= {"uav1/Pose", "uav2/Pose"}
        harness.until(poses)

        def queues():
            return set(offers("send", "uav1/")) == {"uav1/MissionControl"}
        harness.until(queues)

        def types():
            # bash completes what stands behind the last colon.
            return {offer.removeprefix("Uav::") for offer in offers("type", "Uav::Po")} == {"Pose"}
        harness.until(types)


def the_manual_tells_of_every_command_and_every_common_option(rabit):
    manual = (harness.ROOT / "gateway/tool/rabit.1").read_text().replace("\\-", "-")
    commands = subprocess.run([rabit.program, "complete", "--", ""], capture_output=True, text=True, timeout=LIMIT,
                              check=True).stdout.split()
    assert len(commands) >= 9, commands
    for command in commands:
        assert re.search(rf"^\.B[IR]? {command}\b", manual, re.MULTILINE), command
    for option in ("--config", "--domain", "--transport", "--interface", "--keys", "--node", "--wait", "--json",
                   "--verbose"):
        assert option in manual, option


TESTS = [nodes_are_listed_with_what_they_have, nodes_is_a_table_for_people,
         messages_are_listed_with_their_types_and_who_publishes_and_reads_them,
         the_idl_of_a_type_is_had_by_its_name_and_by_a_messages_name,
         a_name_that_is_wrong_is_answered_with_the_nearest, a_value_is_echoed_as_text_as_json_and_in_part,
         a_state_that_was_posted_before_is_echoed_at_once, values_of_several_nodes_are_echoed_together,
         rate_size_and_age_of_a_message_are_measured, a_message_is_sent_and_its_outcome_is_the_exit_code,
         lines_of_standard_input_are_sent_each, what_cannot_be_sent_is_told_with_the_nearest_right_word,
         a_message_is_posted_as_a_node_of_the_given_name, what_cannot_be_posted_is_told,
         ctrl_c_ends_it_well, a_pipe_that_is_closed_ends_it_well, wrong_usage_is_2, nobody_in_the_domain_is_3,
         viewers_elsewhere_are_served_only_by_an_option_that_says_what_it_means,
         a_configuration_of_a_node_serves_for_its_network_alone,
         how_often_all_messages_come_is_measured_together,
         a_doctor_finds_nothing_wrong_with_a_fleet_that_is_well,
         a_doctor_tells_of_the_domain_that_the_others_are_in,
         a_doctor_tells_of_two_nodes_of_one_name_and_of_an_interface_that_is_not_there,
         a_node_that_vanishes_meanwhile_is_waited_for_and_what_is_sent_to_it_is_not_delivered,
         no_text_of_a_stranger_commands_the_terminal,
         configurations_of_a_fleet_are_checked_against_each_other,
         what_a_fleet_puts_on_the_air_is_checked_against_its_budgets,
         shells_complete_commands_and_options, shells_complete_what_the_fleet_has,
         the_manual_tells_of_every_command_and_every_common_option]


def main():
    harness.enter_namespace()
    program, uav, transports = sys.argv[1], sys.argv[2], sys.argv[3].split(",")
    failed = []
    with harness.Processes() as processes:
        for number, transport in enumerate((transports * 2)[:2], 1):
            processes.start([uav, "--config", harness.ROOT / "examples/swarm/uav.yaml", "--node", f"uav{number}",
                             "--domain", harness.domain(), "--transport", transport])
        for transport in transports:
            for test in [test for test in TESTS if not sys.argv[4:] or test.__name__ in sys.argv[4:]]:
                try:
                    test(Rabit(program, transport, harness.domain(), uav))
                    print(f"ok      {transport} {test.__name__}", flush=True)
                except Exception as error:  # pylint: disable=broad-except
                    failed.append(test.__name__)
                    print(f"FAILED  {transport} {test.__name__}: {type(error).__name__} {error}", flush=True)
    sys.exit(f"{len(failed)} failed" if failed else 0)


if __name__ == "__main__":
    main()
