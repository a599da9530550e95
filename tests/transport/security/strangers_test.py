#!/usr/bin/env python3
"""Who is not let into a fleet with keys, by which vendor, and what is said of it. A member over each backend and
somebody who should stay out, over each backend; the members must go on to hear each other.

Usage: strangers_test.py [--silent TRANSPORT] ODD_KEYS PEER TRANSPORT...
--silent: this vendor does not name participants that it does not let in.
Prints for each case who said what. ODD_KEYS and PEER are programs of this folder."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300


class Case:
    """One stranger in a fleet of its own: `prepare` makes what is wrong with it."""

    def __init__(self, programs, transports, stranger, domain, description):
        self.odd_keys, self.peer = programs
        self.transports, self.stranger, self.domain = transports, stranger, domain
        self.name, self.prepare, self.expected = description
        self.node, self.level = "stranger", "encrypt"
        self.failure = None
        self.said = []

    def keys(self, *words):
        done = subprocess.run([self.odd_keys, *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.stderr}")

    def add(self, fleet, node, transport, begins=0, days=365, more=(), domain=None):
        self.keys("add", fleet, node, transport, self.domain if domain is None else domain, begins, days, *more)
        return fleet / node

    def run(self):
        try:
            with tempfile.TemporaryDirectory() as folder, harness.Processes() as processes:
                self.meet(processes, pathlib.Path(folder))
        except Exception as error:  # the others go on
            self.failure = harness.reason(error)

    def meet(self, processes, folder):
        self.fleet = folder / "fleet"
        self.keys("init", self.fleet, "blue")
        members = {f"member{i}": transport for i, transport in enumerate(self.transports)}
        for name, transport in members.items():
            self.add(self.fleet, name, transport)
        strangers_folder = self.prepare(self, folder)
        stranger = processes.start([self.peer, self.stranger, self.node, self.domain, strangers_folder, self.level])
        stranger.wait_for(re.compile("(open)|(failed .*)").fullmatch, LIMIT_S)
        running = {name: processes.start([self.peer, transport, name, self.domain, self.fleet / name, "encrypt"])
                   for name, transport in members.items()}
        # The stranger gets all the time that the members need to hear each other twenty times, and until all that is
        # expected was said: its handshakes may have to wait for those between members.
        for name, process in running.items():
            for other in members.keys() - {name}:
                process.wait_for(re.compile(f"heard {other} 20").fullmatch, LIMIT_S)
        speakers = [("itself", stranger), *((members[name], process) for name, process in running.items())]
        for expected in self.expected:
            wait_until_said(expected, speakers)
        lines = [f"itself: {text}" for _, text in stranger.lines if text.startswith(("failed", "log"))]
        for name, process in running.items():
            lines += [f"{members[name]}: {text}" for _, text in process.lines if text.startswith("log")]
            heard = [text for _, text in process.lines
                     if text.startswith("heard") and text.split()[1] not in members.keys()]
            if heard and not self.may_be_nobody(heard):
                raise AssertionError(f"a member over {members[name]} heard the stranger: {heard}")
        hears = [text for _, text in stranger.lines if text.startswith("heard")]
        if hears and not self.may_hear():
            raise AssertionError(f"the stranger hears members: {hears}")
        self.said = sorted(set(lines))

    def may_be_nobody(self, heard):
        """One with keys and a false name is heard as a program that is no node."""
        return self.name == "another's name" and all(text.split()[1] == "nobody" for text in heard)

    def may_hear(self):
        return self.name == "another's name"


def wait_until_said(expected, speakers):
    def is_said():
        return any(text.startswith(("failed", "log")) and re.search(expected, f"{who}: {text}")
                   for who, process in speakers for _, text in list(process.lines))

    try:
        harness.until(is_said, LIMIT_S)
    except AssertionError:
        raise AssertionError(f"nobody said `{expected}`") from None


def no_keys(_, _folder):
    return "-"


def other_fleet(case, folder):
    other = folder / "other"
    case.keys("init", other, "blue")  # of the same name, even
    return case.add(other, "stranger", case.stranger)


def expired(case, _):
    return case.add(case.fleet, "stranger", case.stranger, -30, 20)


def not_yet_valid(case, _):
    return case.add(case.fleet, "stranger", case.stranger, 30, 20)


def revoked(case, _):
    folder = case.add(case.fleet, "stranger", case.stranger)
    case.keys("revoke", case.fleet, "stranger")
    return folder


def permissions_of_another(case, _):
    folder = case.add(case.fleet, "stranger", case.stranger)
    shutil.copy(case.fleet / "member0" / "permissions.p7s", folder)
    return folder


def permissions_by_identity(case, _):
    folder = case.add(case.fleet, "stranger", case.stranger)
    case.keys("sign_with_identity", case.fleet, "stranger")
    return folder


def tampered(name, old, new):
    def change(case, _):
        folder = case.add(case.fleet, "stranger", case.stranger)
        file = folder / name
        text = file.read_bytes()
        assert old in text
        file.write_bytes(text.replace(old, new))
        return folder
    return change


def other_domain(case, _):
    return case.add(case.fleet, "stranger", case.stranger, domain=case.domain + 1)


def less_protected(case, _):
    case.level = "sign"
    return case.add(case.fleet, "stranger", case.stranger)


def anothers_name(case, _):
    case.node = "member0"
    return case.add(case.fleet, "stranger", case.stranger, more=["member0"])


def other_topic(case, _):
    return case.add(case.fleet, "stranger", case.stranger, more=["stranger", "Other"])


def other_partition(case, _):
    return case.add(case.fleet, "stranger", case.stranger, more=["member0"])


REFUSED = ["itself: failed"]
CASES = [
    ("no keys", no_keys, ["cyclonedds: .*has not the keys of stranger", "fastdds: .*itself stranger was not let in"]),
    ("another fleet's keys", other_fleet, ["was not let in"]),
    ("expired", expired, REFUSED),
    ("not yet valid", not_yet_valid, REFUSED),
    ("revoked", revoked, ["cyclonedds: .*certificate revoked", "fastdds: .*itself stranger was not let in"]),
    ("permissions of another node", permissions_of_another, REFUSED),
    ("permissions signed by the identity authority", permissions_by_identity, REFUSED),
    ("tampered permissions", tampered("permissions.p7s", b"State", b"Other"), REFUSED),
    ("tampered governance", tampered("governance_encrypt.p7s", b"<allow_unauthenticated_participants>false",
                                     b"<allow_unauthenticated_participants>true"), REFUSED),
    ("permissions for another domain", other_domain, []),
    ("less protected", less_protected, ["cyclonedds: .*security_attributes mismatch",
                                        "fastdds: .*itself stranger has another level of security"]),
    ("writes what it may not", other_topic, REFUSED),
    ("writes where it may not, as to a queue", other_partition, REFUSED),
    ("another's name", anothers_name, ["itself member0 and has not the keys of member0"]),
]


def main():
    arguments = sys.argv[1:]
    silent = None
    if arguments[0] == "--silent":
        silent, arguments = arguments[1], arguments[2:]
    programs, transports = arguments[:2], arguments[2:]
    harness.enter_namespace()
    failures = []
    number = 0
    for name, action, said in CASES:
        description = name, action, [line for line in said if not line.startswith(f"{silent}: .*itself stranger")]
        row = []
        for stranger in transports:
            row.append(Case(programs, transports, stranger, (harness.domain() + 3 * number) % 180, description))
            number += 1
        harness.run_at_once(row)
        for case in row:
            print(f"{case.name}, over {case.stranger}: {case.failure or 'stays out'}")
            for line in case.said:
                print(f"    {line}")
            failures += [case] if case.failure else []
    print(f"{number} cases, {len(failures)} failed")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
