#!/usr/bin/env python3
"""What helps who writes: configurations that are checked, completion in the shells, the manual.

Usage: writing_test.py RABIT UAV TRANSPORT[,TRANSPORT]... [TEST]..."""

import json
import pathlib
import re
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


TESTS = [configurations_of_a_fleet_are_checked_against_each_other,
         what_a_fleet_puts_on_the_air_is_checked_against_its_budgets, shells_complete_commands_and_options,
         shells_complete_what_the_fleet_has, the_manual_tells_of_every_command_and_every_common_option]


if __name__ == "__main__":
    main(TESTS)
