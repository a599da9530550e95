#!/usr/bin/env python3
"""What helps who writes: configurations that are checked, completion in the shells, the manual.

Usage: writing_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import tempfile

from two_aircraft import LIMIT, SWARM, harness, keys, main

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
        assert keys(plan) == ["node", "path", "file", "air_bytes_per_s", "budget_bytes_per_s", "not_known", "items"], plan
        assert plan["budget_bytes_per_s"] == 1000 and 740 < plan["air_bytes_per_s"] < 1000, plan
        assert "rate of Pose" not in plan["not_known"] and "rate and size of Findings" in plan["not_known"], plan
        pose = next(item for item in plan["items"] if item["what"] == "Pose")
        assert pose == {"what": "Pose", "bytes": 148, "rate_hz": 5, "copies": 1, "bytes_per_s": 740}, pose
        done = check(rabit, *fleet, "--rate", "Pose=10")
        problem = json.loads(done.stdout.splitlines()[0])
        assert done.returncode == 1 and keys(problem) == ["problem", "file", "line", "nodes"], done
        assert problem["line"] == len(thin.read_text().splitlines()) and problem["nodes"] == ["uav1", "uav2"], problem
        assert "1000 B/s" in problem["problem"] and "Pose" in problem["problem"], problem


COMPLETION = harness.ROOT / "gateway/tool/completion"
# Each shell reads the project's file, then completes as if the words were typed and the tabulator pressed.
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
            # bash completes the text after the last colon.
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


def run(rabit, *arguments, **environment):
    """The program without a network of its own, as in a user's shell."""
    return subprocess.run([rabit.program, *arguments], capture_output=True, text=True, timeout=LIMIT, check=False,
                          env={**os.environ, **environment})


def commands_of(rabit, *before):
    """All commands of the program, as lists of words."""
    names = run(rabit, "complete", "--", *before, "").stdout.split()
    for name in [name for name in names if not name.startswith(":")]:
        if not before and name in ("keys", "lab"):
            yield from commands_of(rabit, name)
        else:
            yield [*before, name]


# A value that is right for each option that may be repeated, if not any text is.
VALUES = {"--interface": "127.0.0.1", "--config": __file__, "--rate": "Pose=1", "--size": "Pose=1", "--rename": "a=b"}


def an_option_takes_one_value_wherever_it_stands(rabit):
    seen = set()
    for command in commands_of(rabit):
        text = run(rabit, *command, "--help").stdout
        options = re.findall(r"^ +(?:-\w,)?(--[a-z-]+) .*\.\.\.", text, re.MULTILINE)
        needed = re.search(r"^Usage: .*\[OPTIONS\](.*)$", text, re.MULTILINE).group(1)
        needed = [__file__ for word in re.sub(r"\[[^]]*\]|\.\.\.", "", needed).split()]
        for option in options:
            value = [option, VALUES.get(option, "x")]
            for words in ([*value, *needed], [*needed, *value]):
                done = run(rabit, *command, *words, "--no-such-option")
                assert "there is no option `--no-such-option`" in done.stderr, (command, words, done.stderr)
            seen.add(option)
    assert seen >= {"--interface", "--except", "--origin", "--config", "--rate", "--include", "--idl"}, seen


def what_is_left_out_of_a_recording_takes_no_message_with_it(rabit):
    for words in (["--except", "*/CameraView", "uav1/Pose"], ["uav1/Pose", "--except", "*/CameraView"]):
        with tempfile.TemporaryDirectory() as folder:
            done = rabit.run("record", *words, "--to", folder, "--for", "1", "--wait", "60", "--json")
            assert done.returncode == 0 and json.loads(done.stdout)["messages"] > 0, done
            assert "recording `uav1/Pose`" in done.stderr and f"recording into {folder}/fleet_" in done.stderr, done


def a_folder_that_cannot_be_written_ends_a_recording_before_it_begins(rabit):
    done = rabit.run("record", "--to", "/proc/nowhere", "--wait", "86400", "--for", "86400")
    assert done.returncode == 1 and done.stdout == "", done
    assert done.stderr == "rabit: /proc/nowhere: No such file or directory\n", done.stderr


def a_size_of_a_recording_needs_a_unit(rabit):
    for option in ("--keep", "--free", "--split-size"):
        for size in ("20", "1000000000", "20XB", "-1GB"):
            done = rabit.run("record", "--to", "/proc/nowhere", f"{option}={size}")
            assert done.returncode == 2, done
            assert f"`{size}`; expected bytes such as 64MB or 1GB" in done.stderr, done.stderr


def a_recording_does_not_keep_less_than_one_file(rabit):
    done = rabit.run("record", "--to", "/proc/nowhere", "--keep", "20MB", "--split-size", "21MB")
    assert done.returncode == 2 and "--keep: less than the size of one file" in done.stderr, done
    done = rabit.run("record", "--to", "/proc/nowhere", "--keep", "21MB", "--split-size", "21MB")
    assert done.stderr == "rabit: /proc/nowhere: No such file or directory\n", done.stderr


def each_command_shows_examples_that_it_understands(rabit):
    with tempfile.TemporaryDirectory() as folder:
        for command in commands_of(rabit):
            text = run(rabit, *command, "--help").stdout
            examples = re.search(r"^Examples:\n((?:  .*\n)+)", text, re.MULTILINE)
            assert examples, (command, text)
            lines = [shlex.split(line) for line in examples.group(1).splitlines()]
            assert len(set(map(tuple, lines))) == 3, (command, lines)
            for line in lines:
                assert line[:1 + len(command)] == ["rabit", *command], line
                for word in [word for word in line if word.endswith(".yaml")]:
                    (pathlib.Path(folder) / word.split("=")[-1]).touch()
                # An unknown option is told of if all else is understood.
                done = subprocess.run([rabit.program, *line[1:], "--no-such-option"], capture_output=True, text=True,
                                      timeout=LIMIT, check=False, cwd=folder)
                assert "there is no option `--no-such-option`" in done.stderr, (line, done.stderr)


def the_environment_stands_for_options_that_the_line_lacks(rabit):
    words = ["echo", "uav1/Pose", "--once", "--transport", rabit.transport, "--wait", "60"]
    here = {"RABIT_DOMAIN": str(harness.domain()), "RABIT_INTERFACE": "127.0.0.1"}
    done = run(rabit, *words, **here)
    assert done.returncode == 0 and done.stdout.startswith("uav1/Pose"), done
    done = run(rabit, "nodes", "--wait", "1", "--domain", str(harness.domain() + 1), **here)
    assert done.returncode == 3 and f"in domain {harness.domain() + 1} " in done.stderr, done
    done = run(rabit, "nodes", RABIT_KEYS="/no/such/folder")
    assert done.returncode == 1 and "/no/such/folder" in done.stderr, done
    assert run(rabit, "nodes", RABIT_DOMAIN="many").returncode == 2


def a_configuration_on_the_line_has_precedence_over_the_environment(rabit):
    with tempfile.TemporaryDirectory() as folder:
        config = pathlib.Path(folder) / "ground.yaml"
        config.write_text(f"node: ground\ndomain: {harness.domain() + 1}\ninterfaces: [127.0.0.1]\n")
        here = {"RABIT_DOMAIN": str(harness.domain()), "RABIT_KEYS": "/no/such/folder"}
        done = run(rabit, "nodes", "--wait", "1", "--config", str(config), **here)
        assert done.returncode == 3 and f"in domain {harness.domain() + 1} " in done.stderr, done
        done = run(rabit, "nodes", "--wait", "1", "--config", str(config), "--domain", str(harness.domain() + 2), **here)
        assert done.returncode == 3 and f"in domain {harness.domain() + 2} " in done.stderr, done


def a_signal_ends_commands_that_read_files(rabit):
    with tempfile.TemporaryDirectory() as folder:
        pipe = pathlib.Path(folder) / "flight.mcap"
        os.mkfifo(pipe)
        for command in ("info", "knew", "check"):
            for number in (signal.SIGTERM, signal.SIGINT):
                # A shell has its jobs in the background ignore SIGINT, and their children inherit that. The program waits
                # for a writer of the pipe.
                with subprocess.Popen([rabit.program, command, str(pipe)], stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL,
                                      preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)) as reading:
                    harness.until(lambda reading=reading: waits_in_open(reading.pid))
                    reading.send_signal(number)
                    assert reading.wait(LIMIT) == -number, (command, number)


def waits_in_open(process):
    return pathlib.Path(f"/proc/{process}/wchan").read_text().startswith(("wait_for_partner", "fifo_open"))


def what_is_no_recording_is_not_recovered(rabit):
    with tempfile.TemporaryDirectory() as folder:
        text = pathlib.Path(folder) / "text.mcap"
        text.write_text("A text, and no recording.\n")
        done = run(rabit, "recover", str(text))
        assert done.returncode == 1 and done.stdout == "" and "is no recording" in done.stderr, done
        assert [file.name for file in pathlib.Path(folder).iterdir()] == ["text.mcap"]


def what_is_no_recording_is_told_by_info_and_knew(rabit):
    with tempfile.TemporaryDirectory() as folder:
        for text in ("", "A text, and no recording.\n"):
            file = pathlib.Path(folder) / "text.mcap"
            file.write_text(text)
            for command in ("info", "knew"):
                done = run(rabit, command, str(file))
                assert done.returncode == 1 and done.stdout == "" and "is no recording" in done.stderr, done


def a_message_that_nobody_publishes_is_told_while_recording(rabit):
    with tempfile.TemporaryDirectory() as folder:
        done = rabit.run("record", "uav1/Poze", "--to", folder, "--for", "4", "--wait", "4")
        assert done.returncode == 1 and done.stdout == "", done
        assert "`uav1` does not publish `Poze`; did you mean `Pose`?" in done.stderr, done
        assert list(pathlib.Path(folder).iterdir()) == [], done


def what_a_recording_does_not_hold_is_told_with_what_it_holds(rabit):
    with tempfile.TemporaryDirectory() as folder:
        done = rabit.run("record", "uav1/Pose", "--to", folder, "--for", "1", "--wait", "60", "--node", "laptop")
        assert done.returncode == 0, done
        file = str(next(pathlib.Path(folder).iterdir()))
        done = run(rabit, "knew", file, "uav1", "uav2/Pose")
        assert done.returncode == 1 and f"{file} holds nothing of what uav1 knew" in done.stderr, done
        assert "`laptop`" in done.stderr, done
        done = run(rabit, "knew", file, "laptop", "uav2/Pose")
        assert done.returncode == 1 and "laptop knew no uav2/Pose in " in done.stderr and "`uav1/Pose`" in done.stderr, done


def a_name_of_a_rate_that_no_node_has_is_wrong_usage(rabit):
    done = check(rabit, *FLEET, "--rate", "Poze=3")
    assert done.returncode == 2 and "no node has a `Poze`; did you mean `Pose`?" in done.stderr, done


def a_message_for_a_foreign_topic_counts(rabit):
    with tempfile.TemporaryDirectory() as folder:
        thin = pathlib.Path(folder) / "uav.yaml"
        thin.write_text("node: uav1\nradio: {budget: 3kB/s}\nforeign:\n"
                        "  - {publish: Setpoint, topic: rt/setpoint, type: Px4::Setpoint, names: ros2}\n")
        idl = pathlib.Path(folder) / "px4.idl"
        idl.write_text("module Px4 { struct Setpoint { octet data[200]; }; };\n")
        done = check(rabit, str(thin), "--idl", str(idl), "--rate", "Setpoint=50")
        assert done.returncode == 1 and "most of it rt/setpoint with 14400 B/s" in done.stdout, done
        done = check(rabit, str(thin), "--idl", str(idl), "--rate", "Setpoint=5")
        assert done.returncode == 0 and done.stderr == "", done


def a_variable_of_the_environment_that_is_wrong_is_named(rabit):
    assert "RABIT_DOMAIN=many" in run(rabit, "nodes", RABIT_DOMAIN="many").stderr


def a_rate_must_be_above_0(rabit):
    done = rabit.run("echo", "uav1/Pose", "--rate", "0")
    assert done.returncode == 2 and "must be a number above 0" in done.stderr and len(done.stderr) < 200, done


def a_recovery_that_does_not_fit_on_the_disk_leaves_no_file(rabit):
    with tempfile.TemporaryDirectory() as folder:
        done = rabit.run("record", "uav1/Pose", "--to", folder, "--for", "1", "--wait", "60")
        assert done.returncode == 0, done
        flight = next(pathlib.Path(folder).iterdir())
        whole = pathlib.Path(folder) / "whole.mcap"

        def recover(most):
            return subprocess.run(["prlimit", f"--fsize={most}", rabit.program, "recover", str(flight), "--to",
                                   str(whole), "--json"], capture_output=True, text=True, timeout=LIMIT, check=False,
                                  restore_signals=False)
        done = recover(500)
        assert done.returncode == 1 and "the disk takes no more; it is removed" in done.stderr, done
        assert not whole.exists()
        done = recover("unlimited")
        assert done.returncode == 0, done
        row = json.loads(done.stdout)
        assert keys(row) == ["file", "messages", "lost", "problems"] and row["messages"] > 0, row


TESTS = [what_is_no_recording_is_told_by_info_and_knew, a_message_that_nobody_publishes_is_told_while_recording,
         what_a_recording_does_not_hold_is_told_with_what_it_holds, a_name_of_a_rate_that_no_node_has_is_wrong_usage,
         a_message_for_a_foreign_topic_counts,
         a_variable_of_the_environment_that_is_wrong_is_named, a_rate_must_be_above_0,
         configurations_of_a_fleet_are_checked_against_each_other,
         what_a_fleet_puts_on_the_air_is_checked_against_its_budgets, shells_complete_commands_and_options,
         shells_complete_what_the_fleet_has, the_manual_tells_of_every_command_and_every_common_option,
         an_option_takes_one_value_wherever_it_stands, what_is_left_out_of_a_recording_takes_no_message_with_it,
         a_folder_that_cannot_be_written_ends_a_recording_before_it_begins, a_size_of_a_recording_needs_a_unit,
         a_recording_does_not_keep_less_than_one_file,
         each_command_shows_examples_that_it_understands, the_environment_stands_for_options_that_the_line_lacks,
         a_configuration_on_the_line_has_precedence_over_the_environment, a_signal_ends_commands_that_read_files, what_is_no_recording_is_not_recovered,
         a_recovery_that_does_not_fit_on_the_disk_leaves_no_file]


if __name__ == "__main__":
    main(TESTS)
