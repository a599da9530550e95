#!/usr/bin/env python3
"""`rabit keys` from the shell: what it says and how it exits. No network.

Usage: keys_test.py RABIT"""

import json
import pathlib
import stat
import subprocess
import sys
import tempfile

LIMIT_S = 60
CONFIG = """node: uav1
domain: 7
publish:
  - {message: Pose, type: Uav::Pose, qos: telemetry}
subscribe:
  - {message: Pose, type: Uav::Pose, from: ["uav*"]}
"""


class Shell:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        (self.folder / "uav1.yaml").write_text(CONFIG)

    def __call__(self, *words):
        return subprocess.run([self.program, "keys", *words], cwd=self.folder, capture_output=True, text=True,
                              timeout=LIMIT_S, check=False)

    def good(self, *words):
        done = self(*words)
        assert done.returncode == 0, (words, done)
        return done.stdout

    def fleet(self):
        self.good("init")
        self.good("add", "uav1", "--config", "uav1.yaml")


def a_fleet_is_made_in_two_commands(shell):
    assert shell.good("init").startswith("keys: fleet `fleet`, valid until ")
    lines = shell.good("add", "uav1", "--config", "uav1.yaml").splitlines()
    assert lines[0].startswith("keys/uav1: valid until "), lines
    assert [line.strip() for line in lines[1:]] == [
        "in domain 7", "writes rabit/Beat, rabit/Link", "writes Pose", "reads rabit/Beat, rabit/Link",
        "reads Pose of uav*"], lines
    key = shell.folder / "keys" / "uav1" / "private_key.pem"
    assert stat.S_IMODE(key.stat().st_mode) == 0o600


def what_is_there_is_not_made_again(shell):
    shell.fleet()
    assert shell("init").returncode == 1
    assert shell("add", "uav1", "--config", "uav1.yaml").returncode == 1


def wrong_usage_is_2(shell):
    shell.good("init")
    for words in ([], ["add"], ["add", "uav1"], ["add", "uav1", "--config", "none.yaml"], ["revoke"], ["init", "--days", "0"],
                  ["add", "uav1", "--tool", "--config", "uav1.yaml"]):
        assert shell(*words).returncode == 2, words


def a_check_tells_whether_all_is_good(shell):
    shell.fleet()
    shell.good("check", "--config", "uav1.yaml")
    shell.good("check", "keys/uav1")


def a_configuration_that_has_changed_is_a_problem_until_it_is_renewed(shell):
    shell.fleet()
    (shell.folder / "uav1.yaml").write_text(CONFIG.replace("{message: Pose, type: Uav::Pose, qos", "{message: Photo, type: Uav::Pose, qos"))
    done = shell("check", "--config", "uav1.yaml")
    assert done.returncode == 1
    assert "problem: may not write Photo of uav1" in done.stdout, done
    assert "problem: may write Pose, which uav1.yaml does not want" in done.stdout, done
    shell.good("renew", "uav1", "--config", "uav1.yaml")
    shell.good("check", "--config", "uav1.yaml")


def a_node_without_keys_is_a_problem(shell):
    shell.good("init")
    done = shell("check", "--config", "uav1.yaml")
    assert done.returncode == 1 and "uav1 has no keys" in done.stderr, done


def what_ends_soon_is_a_problem(shell):
    shell.good("init")
    shell.good("add", "uav1", "--config", "uav1.yaml", "--days", "20")
    done = shell("check")
    assert done.returncode == 1 and "in 19 days; renew it" in done.stdout or "in 20 days; renew it" in done.stdout, done
    shell.good("check", "--ahead", "10")


def a_key_that_others_may_read_is_a_problem(shell):
    shell.fleet()
    (shell.folder / "keys" / "uav1" / "private_key.pem").chmod(0o644)
    done = shell("check")
    assert done.returncode == 1 and "not for its owner alone (mode 644)" in done.stdout, done


def json_is_an_object_for_each_node(shell):
    shell.fleet()
    shell.good("add", "laptop", "--tool", "--domain", "7")
    objects = [json.loads(line) for line in shell.good("check", "--json").splitlines()]
    assert [one["node"] for one in objects] == ["laptop", "uav1"]
    assert list(objects[0]) == ["node", "folder", "until", "may", "problems", "notes"]
    assert "reads everything of everybody" in objects[0]["may"]


def json_is_an_object_for_each_thing_that_was_done(shell):
    def objects(*words):
        return [json.loads(line) for line in shell.good(*words, "--json").splitlines()]
    (made,) = objects("init")
    assert made["folder"] == "keys" and made["fleet"] == "fleet" and list(made) == ["folder", "fleet", "until"], made
    (added,) = objects("add", "uav1", "--config", "uav1.yaml")
    assert list(added) == ["node", "folder", "until", "may"] and "writes Pose" in added["may"], added
    (renewed,) = objects("renew", "uav1", "--revoke-old")
    assert list(renewed) == ["node", "folder", "until", "may", "revoked"] and renewed["revoked"] == 1, renewed
    assert objects("revoke", "uav1") == [{"node": "uav1", "revoked": 1}]


def who_is_revoked_is_gone(shell):
    shell.fleet()
    assert "1 certificates are revoked" in shell.good("revoke", "uav1")
    assert not (shell.folder / "keys" / "uav1").exists()
    assert shell("renew", "uav1").returncode == 1


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    tests = [a_fleet_is_made_in_two_commands, what_is_there_is_not_made_again, wrong_usage_is_2,
             a_check_tells_whether_all_is_good, a_configuration_that_has_changed_is_a_problem_until_it_is_renewed,
             a_node_without_keys_is_a_problem, what_ends_soon_is_a_problem, a_key_that_others_may_read_is_a_problem,
             json_is_an_object_for_each_node, json_is_an_object_for_each_thing_that_was_done, who_is_revoked_is_gone]
    failed = 0
    for test in tests:
        with tempfile.TemporaryDirectory() as folder:
            try:
                test(Shell(program, folder))
                print(f"good: {test.__name__}")
            except AssertionError as error:
                failed += 1
                print(f"FAILED: {test.__name__}: {error}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
