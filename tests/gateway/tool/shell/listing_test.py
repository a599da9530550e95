#!/usr/bin/env python3
"""What `rabit` tells of a fleet: its nodes, messages and types, and who does not find it.

Usage: listing_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import re
import subprocess
import tempfile

from two_aircraft import LIMIT, SWARM, Rabit, aircraft_config, harness, is_well, keys, main

HASH = re.compile(r"^[0-9a-f]{16}$")


def nodes_are_listed_with_what_they_have(rabit):
    def both():
        listed, done = rabit.objects("nodes", "--wait", "10")
        rows = {row["node"]: row for row in listed if "node" in row and "problem" not in row}
        return (rows, done) if {"uav1", "uav2"} <= set(rows) and is_well(done) else None

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


def foreign_topics_are_listed_with_their_states(rabit):
    alone = Rabit(rabit.program, rabit.transport, (rabit.domain + 60) % 200)
    with tempfile.TemporaryDirectory() as folder:
        config = aircraft_config(folder)
        config.write_text(config.read_text() + "foreign:\n  - {subscribe: /goals, type: Uav::Goto, as: Goals, names: ros2}\n")
        with harness.Processes() as processes:
            processes.start([rabit.uav, "--config", config, "--node", "lab", "--domain", str(alone.domain),
                             "--transport", alone.transport])
            for command in ("nodes", "messages"):
                def told(command=command):
                    listed, _ = alone.objects(command, "--foreign", "--wait", "10")
                    return [row for row in listed if "foreign" in row]
                (row,) = harness.until(told)
                assert keys(row) == ["foreign", "node", "type", "local", "written", "state", "reason", "qos", "samples",
                                     "readers"], row
                assert (row["foreign"], row["node"], row["local"], row["state"]) == ("rt/goals", "lab", "Goals", "LOST"), row
                assert "no program writes `rt/goals`" in row["reason"], row
            table = alone.run("nodes", "--foreign", "--wait", "10").stdout
            assert "FOREIGN TOPIC" in table and "rt/goals" in table, table


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


def how_often_all_messages_come_is_measured_together(rabit):
    listed, done = rabit.objects("messages", "--for", "3", "--wait", "60")
    rates = {row["message"]: row["rate_hz"] for row in listed}
    assert done.returncode == 0 and 2 < rates["Pose"] < 200, done
    table = rabit.run("messages", "--for", "1")
    assert table.stdout.split("\n")[0].split() == "MESSAGE TYPE QOS RATE PUBLISHED BY READ BY".split(), table


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
                            (("type", "Goto"), "did you mean `Uav::Goto`?"),
                            (("echo", "uav1/Poze"), "did you mean `Pose`?"),
                            (("echo", "uaw1/Pose"), "did you mean `uav1`?")):
        done = rabit.run_until_heard(*arguments, reason=hint)
        assert done.returncode == 1 and hint in done.stderr and done.stdout == "", done


def what_a_node_does_not_have_is_told_as_soon_as_its_announcement_is_there(rabit):
    # Longer than the test may last: only the announcement ends the wait.
    for arguments in (("echo", "uav1/Poze"), ("send", "uav1/MissionControl", "Uav::GoHom", "{}"),
                      ("send", "uav1/MissionContro", "Uav::GoHome", "{}")):
        done = rabit.run(*arguments, "--wait", "86400")
        assert done.returncode == 1 and "did you mean" in done.stderr, done


def another_aircraft_is_not_proposed_for_one_that_is_not_there(rabit):
    for arguments in (("echo", "uav3/Pose"), ("send", "uav3/MissionControl", "Uav::GoHome", "{}")):
        done = rabit.run_until_heard(*arguments)
        assert done.returncode == 1 and "node `uav3` was not heard within " in done.stderr and "; there: " in done.stderr, done


def a_mistyped_command_or_option_is_answered_with_the_nearest(rabit):
    for words, answer in ((["nods"], "there is no command `nods`; did you mean `nodes`?"),
                          (["keys", "renw"], "there is no command `renw`; did you mean `renew`?"),
                          (["nodes", "--domian", "5"], "there is no option `--domian`; did you mean `--domain`?"),
                          (["echo", "--domian", "5", "uav1/Pose"], "did you mean `--domain`?"),
                          (["--domain", "5", "nodes"], "the option `--domain` belongs behind its command: rabit nodes --domain"),
                          (["--domain=5", "-v", "echo", "a/b"], "`--domain` belongs behind its command: rabit echo --domain"),
                          (["keys", "--days", "5", "add", "a"], "`--days` belongs behind its command: rabit keys add --days")):
        done = subprocess.run([rabit.program, *words], capture_output=True, text=True, timeout=LIMIT, check=False)
        assert done.returncode == 2 and answer in done.stderr and done.stderr.count("\n") == 1, done


def whoever_asks_again_and_again_is_answered(rabit):
    def both():
        return set(re.findall(r"^uav\d", rabit.run("nodes").stdout, re.MULTILINE)) == {"uav1", "uav2"}
    harness.until(both)
    for number in range(1, 13):
        done = rabit.run("nodes", "--wait", "30")
        assert is_well(done), (number, done)


def the_problems_of_the_nodes_are_told_each_time(rabit):
    def missing(done):
        # The aircraft have no camera here.
        return [node for node in ("uav1", "uav2") if not re.search(rf"^! nodes?( uav\d)*? {node}( uav\d)*: subscribe Targets", done.stdout, re.M)]
    harness.until(lambda: not missing(rabit.run("nodes")))
    for number in range(1, 7):
        done = rabit.run("nodes", "--wait", "30")
        assert done.returncode == 1 and not missing(done), (number, done)


def output_that_cannot_be_written_is_told_by_every_command(rabit):
    check = [rabit.program, "check", str(SWARM / "uav.yaml")]
    for argv in (rabit.argv("nodes"), rabit.argv("messages"), rabit.argv("echo", "uav1/Pose", "--once", "--wait", "30"),
                 rabit.argv("doctor", "--json", "--wait", "1"), check, [rabit.program, "--help"]):
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run(argv, stdout=full, stderr=subprocess.PIPE, text=True, timeout=LIMIT, check=False)
        assert done.returncode != 0, (argv, done)
        assert "rabit: cannot write: No space left on device\n" in done.stderr, (argv, done)


def a_tool_does_not_appear_under_the_name_of_a_node(rabit):
    for words in (["nodes"], ["echo", "uav2/Health", "--once"], ["send", "uav2/MissionControl", "Uav::GoHome", "{}"]):
        done = rabit.run(*words, "--node", "uav1", "--wait", "60")
        assert done.returncode == 1 and done.stdout == "", done
        assert done.stderr == "rabit: there is a node `uav1`; two of one name would disturb each other\n", done


def a_wildcard_is_refused_where_one_node_is_meant(rabit):
    for words in (["ping", "uav*"], ["log", "uav?"], ["send", "uav*/MissionControl", "Uav::GoHome", "{}"]):
        done = rabit.run(*words)
        assert done.returncode == 2 and "wildcards are not taken here" in done.stderr, done


def an_interface_that_is_not_there_is_the_reason(rabit):
    done = subprocess.run([rabit.program, "nodes", "--interface", "nosuch0", "--transport", rabit.transport],
                          capture_output=True, text=True, timeout=LIMIT, check=False)
    assert done.returncode == 3 and "nosuch0" in done.stderr and "timed out" not in done.stderr, done
    assert "`rabit doctor`" in done.stderr.splitlines()[0], done.stderr


def a_configuration_of_a_node_serves_for_its_network_alone(rabit):
    done = subprocess.run([rabit.program, "echo", "uav1/Pose", "--once", "--wait", "30",
                           "--config", str(harness.ROOT / "examples/swarm/uav.yaml"),
                           "--domain", str(harness.domain())], capture_output=True, text=True, timeout=LIMIT,
                          check=False)
    assert done.returncode == 0, done.stderr


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
        assert "`rabit doctor`" in done.stderr.splitlines()[0], done.stderr


def viewers_elsewhere_are_served_only_by_an_option_that_says_what_it_means(rabit):
    done = rabit.run("foxglove", "--listen", "0.0.0.0", "--port", "0")
    assert done.returncode == 2 and done.stdout == "", done
    assert "there is no TLS" in done.stderr and "--open-to-everybody-on-the-network" in done.stderr, done


TESTS = [nodes_are_listed_with_what_they_have, nodes_is_a_table_for_people,
         messages_are_listed_with_their_types_and_who_publishes_and_reads_them,
         how_often_all_messages_come_is_measured_together, the_idl_of_a_type_is_had_by_its_name_and_by_a_messages_name,
         a_name_that_is_wrong_is_answered_with_the_nearest,
         foreign_topics_are_listed_with_their_states,
         what_a_node_does_not_have_is_told_as_soon_as_its_announcement_is_there,
         another_aircraft_is_not_proposed_for_one_that_is_not_there, a_mistyped_command_or_option_is_answered_with_the_nearest, whoever_asks_again_and_again_is_answered, the_problems_of_the_nodes_are_told_each_time,
         output_that_cannot_be_written_is_told_by_every_command, a_tool_does_not_appear_under_the_name_of_a_node,
         a_wildcard_is_refused_where_one_node_is_meant,
         an_interface_that_is_not_there_is_the_reason, a_configuration_of_a_node_serves_for_its_network_alone,
         wrong_usage_is_2, nobody_in_the_domain_is_3,
         viewers_elsewhere_are_served_only_by_an_option_that_says_what_it_means]


if __name__ == "__main__":
    main(TESTS)
