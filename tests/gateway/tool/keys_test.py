#!/usr/bin/env python3
"""`rabit keys` from the shell: what it says and how it exits. No network.

Usage: keys_test.py RABIT"""

import json
import os
import pathlib
import pty
import stat
import subprocess
import sys
import tempfile
import termios

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import harness  # noqa: E402

LIMIT_S = 300
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

    def __call__(self, *words, **more):
        """In a session of its own: without a terminal."""
        more = {"cwd": self.folder, "capture_output": True, "text": True, "timeout": LIMIT_S, "check": False,
                "start_new_session": True, **more}
        return subprocess.run([self.program, "keys", *words], **more)

    def good(self, *words, **more):
        done = self(*words, **more)
        assert done.returncode == 0, (words, done)
        return done.stdout

    def type(self, text, *words):
        """At a terminal, where somebody types `text`; returns the exit code and what the terminal showed."""
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.folder)
            os.execv(self.program, [str(self.program), "keys", *words])
        shown = b""
        try:
            for line in text:
                while not shown.endswith(b": "):
                    shown += os.read(terminal, 1000)
                # The program writes first, and then turns the echo off.
                harness.until(lambda: not termios.tcgetattr(terminal)[3] & termios.ECHO)
                os.write(terminal, line.encode() + b"\n")
                shown += b"\n"
            while True:
                part = os.read(terminal, 1000)
                if not part:
                    break
                shown += part
        except OSError:  # it has ended
            pass
        os.close(terminal)
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), shown.decode()

    def secret(self, name, text):
        (self.folder / name).write_text(text)
        (self.folder / name).chmod(0o600)
        return name

    def request(self, node, folder):
        self.good("request", node, "--to", folder)
        return f"{folder}/{node}.request.pem"

    def fleet(self):
        self.good("init")
        self.good("add", "uav1", "--config", "uav1.yaml")


def a_fleet_is_made_in_two_commands(shell):
    assert shell.good("init") == "keys: a new fleet\n"
    lines = shell.good("add", "uav1", "--config", "uav1.yaml").splitlines()
    assert lines[0].startswith("keys/uav1: valid until "), lines
    assert [line.strip() for line in lines[1:]] == [
        "writes rabit/Beat, rabit/Link, Pose", "reads rabit/Beat, rabit/Link, Pose"], lines
    folder = shell.folder / "keys" / "uav1"
    assert sorted(file.name for file in folder.iterdir()) == ["authority", "bulletin", "certificate", "key", "permissions"]
    assert stat.S_IMODE((folder / "key").stat().st_mode) == 0o600
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def what_is_there_is_not_made_again(shell):
    shell.fleet()
    for words in (["init"], ["add", "uav1", "--config", "uav1.yaml"]):
        done = shell(*words)
        assert done.returncode == 1 and "already" in done.stderr, done


def wrong_usage_is_2(shell):
    shell.good("init")
    for words in ([], ["add"], ["add", "uav1"], ["add", "uav1", "--config", "none.yaml"], ["revoke"],
                  ["add", "uav1", "--tool", "--days", "0"], ["request"], ["sign"], ["sign", "x.pem"],
                  ["init", "other", "--name", "fleet"], ["add", "uav1", "--tool", "--domain", "7"],
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
    assert "problem: may not write Photo, which uav1.yaml wants" in done.stdout, done
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
    (shell.folder / "keys" / "uav1" / "key").chmod(0o644)
    done = shell("check")
    assert done.returncode == 1 and "not for its owner alone (mode 644)" in done.stdout, done


def json_is_an_object_for_each_node(shell):
    shell.fleet()
    shell.good("add", "laptop", "--tool")
    objects = [json.loads(line) for line in shell.good("check", "--json").splitlines()]
    assert [one["node"] for one in objects] == ["laptop", "uav1"]
    assert list(objects[0]) == ["node", "folder", "until", "may", "problems", "notes"]
    assert objects[0]["may"] == ["writes rabit/Beat, rabit/Link", "reads everything"], objects
    assert all(not one["problems"] for one in objects), objects


def json_is_an_object_for_each_thing_that_was_done(shell):
    def objects(*words):
        return [json.loads(line) for line in shell.good(*words, "--json").splitlines()]
    assert objects("init") == [{"folder": "keys", "encrypted": False}]
    (added,) = objects("add", "uav1", "--config", "uav1.yaml")
    assert list(added) == ["node", "folder", "until", "may"] and "Pose" in added["may"][0], added
    (renewed,) = objects("renew", "uav1", "--revoke-old")
    assert list(renewed) == ["node", "folder", "until", "may", "revoked"] and renewed["revoked"] == 1, renewed
    assert objects("revoke", "uav1") == [{"node": "uav1", "revoked": 1}]


def who_is_revoked_is_gone(shell):
    shell.fleet()
    assert "1 certificate is revoked" in shell.good("revoke", "uav1")
    assert not (shell.folder / "keys" / "uav1").exists()
    assert shell("renew", "uav1").returncode == 1
    assert "uav1: revoked\n" in shell.good("check")


def a_revocation_tells_what_is_removed_and_what_to_copy(shell):
    shell.fleet()
    shell.good("add", "laptop", "--tool")
    done = shell("revoke", "laptop")
    assert done.stdout == "laptop: 1 certificate is revoked\n", done
    assert "the folder keys/laptop is removed" in done.stderr, done
    assert sum("copy keys/authority/bulletin into the folder of keys of any one node" in line for line in done.stderr.splitlines()) == 1, done


def a_node_that_lacks_the_newest_bulletin_is_a_problem(shell):
    shell.fleet()
    shell.good("add", "laptop", "--tool")
    bulletin = shell.folder / "keys" / "uav1" / "bulletin"
    before = bulletin.read_bytes()
    shell.good("revoke", "laptop")
    bulletin.write_bytes(before)
    done = shell("check")
    assert done.returncode == 1 and "its bulletin is of epoch 1, and the fleet is in epoch 2" in done.stdout, done


def a_node_keeps_its_private_key(shell):
    shell.good("init")
    printed = shell.good("request", "uav1", "--to", "there")
    key = printed.split()[-1]
    lines = shell.good("sign", "there/uav1.request.pem", "--config", "uav1.yaml").splitlines()
    assert lines[0].startswith("keys/uav1: valid until ") and lines[-1].split() == ["key", key], (printed, lines)
    assert not any("PRIVATE KEY" in file.read_text(errors="replace") for file in (shell.folder / "keys" / "uav1").iterdir())
    assert shell("check", "there").returncode == 1
    for file in (shell.folder / "keys" / "uav1").iterdir():
        (shell.folder / "there" / file.name).write_bytes(file.read_bytes())
    shell.good("check", "there", "--config", "uav1.yaml")


def a_check_of_the_fleet_needs_no_private_key(shell):
    shell.good("init")
    shell.good("sign", shell.request("uav1", "there"), "--config", "uav1.yaml")
    for folder in ("keys", "keys/uav1"):
        assert "note: its private key is on the node alone" in shell.good("check", folder, "--config", "uav1.yaml")


def requests_of_several_nodes_are_signed_together(shell):
    shell.good("init")
    files = [shell.request(node, node) for node in ("uav1", "uav2")]
    lines = shell.good("sign", *files, "--config", "uav1.yaml", "--json").splitlines()
    made = [json.loads(line) for line in lines]
    assert [one["node"] for one in made] == ["uav1", "uav2"] and len({one["key"] for one in made}) == 2, made


def a_bad_request_leaves_all_unsigned(shell):
    shell.good("init")
    (shell.folder / "bad.pem").write_text("bad")
    done = shell("sign", shell.request("uav1", "uav1"), "bad.pem", "--config", "uav1.yaml")
    assert done.returncode == 1 and "bad.pem" in done.stderr and len(done.stderr.splitlines()) == 1, done
    assert not (shell.folder / "keys" / "uav1").exists()


def a_request_of_a_node_that_has_keys_leaves_all_unsigned(shell):
    shell.fleet()
    files = [shell.request(node, f"{node}_there") for node in ("uav2", "uav1")]
    done = shell("sign", *files, "--config", "uav1.yaml")
    assert done.returncode == 1 and "keys/uav1 is there already" in done.stderr and done.stdout == "", done
    assert not (shell.folder / "keys" / "uav2").exists()


def a_request_does_not_replace_a_node(shell):
    shell.fleet()
    request = shell.request("uav1", "there")
    assert "there already" in shell("sign", request, "--config", "uav1.yaml").stderr
    assert "valid until" in shell.good("renew", "uav1", "--request", request)
    assert not (shell.folder / "keys" / "uav1" / "key").exists()
    assert shell("renew", "uav1", "uav2", "--request", request).returncode == 2


def a_passphrase_comes_from_a_file_a_pipe_or_the_environment(shell):
    assert "encrypted" in shell.good("init", "--passphrase-file", shell.secret("word", "open sesame\n"))
    shell.good("add", "uav1", "--config", "uav1.yaml", "--passphrase-file", "word")
    reading, writing = os.pipe()
    os.write(writing, b"open sesame\n")
    os.close(writing)
    shell.good("renew", "uav1", "--passphrase-file", f"/dev/fd/{reading}", pass_fds=(reading,))
    os.close(reading)
    known = {**os.environ, "RABIT_KEYS_PASSPHRASE": "open sesame"}
    shell.good("sign", shell.request("uav2", "there"), "--config", "uav1.yaml", env=known)
    shell.good("revoke", "uav1", env=known)
    shell.good("check", "keys")


def a_passphrase_is_typed_unseen(shell):
    code, shown = shell.type(["open sesame", "open sesame"], "init", "--passphrase")
    assert code == 0 and "New passphrase" in shown and "sesame" not in shown, shown
    code, shown = shell.type(["open sesame"], "add", "uav1", "--config", "uav1.yaml")
    assert code == 0 and "keys/uav1: valid until" in shown and "sesame" not in shown, shown
    code, shown = shell.type(["wrong"], "renew", "uav1")
    assert code == 1 and "the passphrase does not open keys/authority/" in shown, shown


def two_new_passphrases_that_differ_make_no_fleet(shell):
    code, shown = shell.type(["one word", "another"], "init", "--passphrase")
    assert code == 1 and not (shell.folder / "keys").exists(), shown


def without_a_passphrase_one_line_says_how_to_give_it(shell):
    shell.good("init", "--passphrase-file", shell.secret("word", "open sesame\n"))
    for words in (["add", "uav1", "--config", "uav1.yaml"], ["add", "uav1", "--config", "uav1.yaml", "--passphrase-file", "no"],
                  ["add", "uav1", "--config", "uav1.yaml", "--passphrase-file", shell.secret("empty", "\n")]):
        done = shell(*words, stdin=subprocess.DEVNULL)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done
    assert "--passphrase-file" in shell("add", "uav1", "--config", "uav1.yaml", input="open sesame\n").stderr
    (shell.folder / "word").chmod(0o644)
    done = shell("add", "uav1", "--config", "uav1.yaml", "--passphrase-file", "word")
    assert done.returncode == 1 and "(mode 644)" in done.stderr, done


def a_certificate_that_keeps_its_key_is_not_revoked(shell):
    shell.good("init")
    shell.good("sign", shell.request("uav1", "there"), "--config", "uav1.yaml")
    done = shell("renew", "uav1", "--revoke-old")
    assert done.returncode == 1 and "keeps its key" in done.stderr, done


def keys_of_the_former_format_are_refused_in_one_line(shell):
    for file in ("old/authority/identity.pem", "old/uav1/certificate.pem"):
        (shell.folder / file).parent.mkdir(parents=True)
        (shell.folder / file).write_text("X.509")
    for words in (["check", "old"], ["check", "old/uav1"], ["init", "old"], ["add", "uav2", "--tool", "--keys", "old"],
                  ["add", "uav2", "--tool", "--keys", "old/uav1"], ["renew", "uav1", "--keys", "old"], ["revoke", "uav1", "--keys", "old"],
                  ["request", "uav1", "--to", "old/uav1"]):
        done = shell(*words)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and done.stdout == "", (words, done)
        assert "`rabit keys init`" in done.stderr and "`rabit keys add`" in done.stderr, (words, done)
    (shell.folder / "old.request.pem").write_text("-----BEGIN CERTIFICATE REQUEST-----\nMIH4\n-----END CERTIFICATE REQUEST-----\n")
    done = shell("sign", "old.request.pem", "--tool")
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done
    assert "old.request.pem is a request of a former format" in done.stderr and "`rabit keys request`" in done.stderr, done


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    tests = [a_fleet_is_made_in_two_commands, what_is_there_is_not_made_again, wrong_usage_is_2,
             a_check_tells_whether_all_is_good, a_configuration_that_has_changed_is_a_problem_until_it_is_renewed,
             a_node_without_keys_is_a_problem, what_ends_soon_is_a_problem, a_key_that_others_may_read_is_a_problem,
             json_is_an_object_for_each_node, json_is_an_object_for_each_thing_that_was_done, who_is_revoked_is_gone,
             a_revocation_tells_what_is_removed_and_what_to_copy, a_node_that_lacks_the_newest_bulletin_is_a_problem,
             a_node_keeps_its_private_key, a_check_of_the_fleet_needs_no_private_key,
             requests_of_several_nodes_are_signed_together, a_bad_request_leaves_all_unsigned,
             a_request_of_a_node_that_has_keys_leaves_all_unsigned, a_request_does_not_replace_a_node, a_passphrase_comes_from_a_file_a_pipe_or_the_environment,
             a_passphrase_is_typed_unseen, two_new_passphrases_that_differ_make_no_fleet,
             without_a_passphrase_one_line_says_how_to_give_it, a_certificate_that_keeps_its_key_is_not_revoked,
             keys_of_the_former_format_are_refused_in_one_line]
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
