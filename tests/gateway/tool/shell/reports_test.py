#!/usr/bin/env python3
"""What nodes tell of themselves: their own problems, their logs, round trips, and what they send.

Usage: reports_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import contextlib
import json
import pathlib
import re
import subprocess
import tempfile

from two_aircraft import LIMIT, aircraft_config, harness, keys, main

PROBLEM = "subscribe Pse: uav1 does not publish `Pse`"  # it names what uav1 publishes behind that


@contextlib.contextmanager
def troubled(rabit):
    """A node uav7 that subscribes to a message that uav1 does not publish."""
    with tempfile.TemporaryDirectory(prefix="rabit_reports_") as folder, harness.Processes() as processes:
        config = aircraft_config(folder, "  - {message: Pse, type: Uav::Pose, from: [uav1]}\n")
        yield processes.start([rabit.uav, "--config", config, "--node", "uav7", "--domain", rabit.domain,
                               "--transport", rabit.transport])


def the_own_problems_of_a_node_are_listed_and_diagnosed(rabit):
    with troubled(rabit):
        def listed():
            done = rabit.run("nodes", "--wait", "4")
            return done.returncode == 1 and f"! node uav7: {PROBLEM}" in done.stdout
        harness.until(listed)

        def in_objects():
            rows, _ = rabit.objects("nodes", "--wait", "4")
            return [row for row in rows if "problem" in row and row["node"] == "uav7" and row["reason"].startswith(PROBLEM)]
        problems = harness.until(in_objects)
        assert any(keys(row) == ["problem", "node", "reason"] and row["problem"] == "node uav7" for row in problems), problems

        def diagnosed():
            done = rabit.run("doctor", "--wait", "4")
            return done.returncode == 1 and f"! node uav7: {PROBLEM}" in done.stdout
        harness.until(diagnosed)


def the_last_lines_of_a_log_are_shown_with_the_node_running_on(rabit):
    with troubled(rabit):
        def logged():
            done = rabit.run("log", "uav7", "--wait", "30")
            return done if done.returncode == 0 and PROBLEM.split(": ")[1] in done.stdout else None
        done = harness.until(logged)
        first = done.stdout.splitlines()[0]
        assert re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z info gateway: node uav7, host ", first), first
        done = rabit.run("log", "uav7", "-n", "1", "--wait", "30")
        assert done.returncode == 0 and done.stdout.count("\n") == 1, done
        rows, _ = rabit.objects("log", "uav7", "--wait", "30")
        assert all(keys(row) == ["node", "time", "level", "text"] for row in rows), rows
        assert rows[0]["level"] == "info" and rows[0]["text"].startswith("gateway: node uav7"), rows


def a_log_is_followed_while_it_is_written(rabit):
    with harness.Processes() as processes:
        # It is there before the node, whose first lines may be earlier than it is heard.
        follower = processes.start(rabit.argv("log", "uav7", "-f", "-n", "100", "--wait", str(LIMIT)))
        with troubled(rabit) as uav:
            follower.wait_for(re.compile(r".* warning gateway: subscribe Pse.*: uav1 does not publish `Pse`.*").fullmatch, LIMIT)
            assert uav.terminate() == 0
            follower.wait_for(re.compile(r"rabit: uav7 is LOST").fullmatch, LIMIT)
        assert follower.terminate() == 0


def a_node_is_pinged(rabit):
    done = rabit.run("ping", "uav1", "-c", "3", "--wait", "30")
    lines = done.stdout.splitlines()
    assert done.returncode == 0 and len(lines) == 4, done
    assert all(re.fullmatch(rf"uav1  {i + 1}  [\d.]+ ms", lines[i]) for i in range(3)), lines
    assert re.fullmatch(r"3 of 3 answered, loss 0 %; min [\d.]+ ms  p50 [\d.]+ ms  p99 [\d.]+ ms  max [\d.]+ ms",
                        lines[3]), lines
    rows, _ = rabit.objects("ping", "uav2", "-c", "2", "--wait", "30")
    assert keys(rows[0]) == ["node", "number", "round_trip_s"] and 0 < rows[0]["round_trip_s"] < 60, rows
    assert keys(rows[2]) == ["node", "sent", "answered", "loss", "min_s", "p50_s", "p99_s", "max_s"], rows


def a_node_that_is_not_there_is_neither_pinged_nor_has_it_a_log(rabit):
    for command in ("ping", "log"):
        done = rabit.run_until_heard(command, "uav3")
        assert done.returncode == 1 and "node `uav3` was not heard within" in done.stderr and done.stdout == "", done


def the_channel_is_shown_by_node_and_class(rabit):
    def both():
        done = rabit.run("top", "--once", "--wait", "4")
        return done if done.returncode == 0 and "uav1" in done.stdout and "uav2" in done.stdout else None
    lines = harness.until(both).stdout.splitlines()
    assert lines[0].split() == ["NODE", "B/s", "BUDGET", "CAPACITY", "DISCOVERY", "PRESENCE", "COMMAND", "STATE",
                                "TELEMETRY", "BULK", "FOREIGN"], lines
    assert lines[-1].startswith("in all"), lines

    def measured():
        rows, _ = rabit.objects("top", "--once", "--wait", "4")
        return next((row for row in rows if row["node"] == "uav1" and row["telemetry"]), None)
    uav = harness.until(measured)
    assert keys(uav) == ["node", "bytes_per_s", "budget_bytes_per_s", "capacity_bytes_per_s", "discovery", "presence",
                         "command", "state", "telemetry", "bulk", "foreign"], json.dumps(uav)
    assert uav["telemetry"] > 0 and uav["budget_bytes_per_s"] is None, uav


def nodes_are_offered_to_a_shell(rabit):
    def offered():
        done = subprocess.run([rabit.program, "complete", "--", "log", "--domain", str(rabit.domain), "--transport",
                               rabit.transport, "--interface", "127.0.0.1", "u"], capture_output=True, text=True,
                              timeout=LIMIT, check=False)
        return {"uav1", "uav2"} <= set(done.stdout.split())
    harness.until(offered)


def a_node_that_sends_no_files_is_named_without_a_try(rabit):
    with tempfile.TemporaryDirectory() as folder:
        done = rabit.run("fetch", "uav1:none", "--to", f"{folder}/none", "--wait", "60")
        assert (done.returncode, done.stdout) == (1, ""), done
        assert done.stderr == "rabit: uav1 sends no files: its configuration has no `fetch`\n", done
        assert not list(pathlib.Path(folder).iterdir()), done


def the_members_and_their_claims_are_shown(rabit):
    with tempfile.TemporaryDirectory(prefix="rabit_claims_") as folder, harness.Processes() as processes:
        config = aircraft_config(folder)
        config.write_text(config.read_text() + "agreement: {members: [uav7, uav8]}\n")

        def start(node):
            processes.start([rabit.uav, "--config", config, "--node", node, "--domain", rabit.domain, "--transport",
                             rabit.transport])
        start("uav7")

        def alone():
            done = rabit.run("claims", "--wait", "4")
            return done if "uav7 uav8" in done.stdout else None
        done = harness.until(alone)
        assert done.returncode == 1 and done.stdout.splitlines() == [
            "no claim is held",
            "members uav7 uav8; lease 2.0 s; 1 of 2 told their claims",
            "! node uav8: it is a member of the agreement and is not heard",
            "! agreement of uav7: 1 of 2 members told that they have this list, and a majority is 2"], done
        start("uav8")

        def whole():
            rows, done = rabit.objects("claims", "--wait", "4")
            return rows if done.returncode == 0 else None
        assert harness.until(whole) == [{"members": ["uav7", "uav8"], "lease_s": 2.0, "nodes": ["uav7", "uav8"]}]


TESTS = [the_own_problems_of_a_node_are_listed_and_diagnosed, the_last_lines_of_a_log_are_shown_with_the_node_running_on,
         a_log_is_followed_while_it_is_written, a_node_is_pinged,
         a_node_that_is_not_there_is_neither_pinged_nor_has_it_a_log, the_channel_is_shown_by_node_and_class,
         nodes_are_offered_to_a_shell, a_node_that_sends_no_files_is_named_without_a_try,
         the_members_and_their_claims_are_shown]


if __name__ == "__main__":
    main(TESTS)
