#!/usr/bin/env python3
"""A node whose folder of keys cannot be used ends before it joins the network, with the exit code 2 and one line that says what
is wrong and what to do.

Usage: folders_test.py RABIT LEDGER_NODE TRANSPORT..."""

import pathlib
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integration"))
import field  # noqa: E402
import fleet_keys  # noqa: E402
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300


def missing(folder, _):
    shutil.rmtree(folder)


def requested_alone(folder, _):
    for name in ("authority", "bulletin", "certificate", "permissions"):
        (folder / name).unlink()


def of_former_format(folder, _):
    for file in folder.iterdir():
        file.unlink()
    for name in ("certificate.pem", "identity_authority.pem", "permissions.p7s", "permissions_authority.pem", "private_key.pem"):
        (folder / name).write_text("-----BEGIN CERTIFICATE-----\n", encoding="ascii")


def damaged(name):
    def damage(folder, _):
        (folder / name).write_text((folder / name).read_text(encoding="ascii").replace("-----END", "----"), encoding="ascii")
    return damage


def of(name, whose):
    return lambda folder, others: shutil.copy(others[whose] / name, folder)


def for_all(folder, _):
    (folder / "key").chmod(0o644)


def of_another_node(folder, others):
    shutil.rmtree(folder)
    shutil.copytree(others["uav2"], folder)


CASES = [(missing, "there is no folder of keys"), (requested_alone, "`rabit keys sign`"), (of_former_format, "`rabit keys init`"),
         (damaged("certificate"), "it is damaged"), (damaged("permissions"), "it is damaged"),
         (damaged("bulletin"), "it is damaged"), (damaged("key"), "private key"),
         (damaged("authority"), "is no public key"),
         (of("certificate", "stranger"), "not signed by the authority"),
         (of("bulletin", "stranger"), "not signed by the authority"),
         (of("permissions", "laptop"), "does not belong to the certificate"), (of("key", "uav2"), "is not the key of"),
         (for_all, "is not for its owner alone"), (of_another_node, "is for the node `uav2`, and this is `uav1`")]


def main():
    (rabit, ledger_node), transports = sys.argv[1:3], sys.argv[3:]
    harness.enter_namespace()
    failures = []
    with tempfile.TemporaryDirectory() as root, harness.Processes() as processes:
        root = pathlib.Path(root)
        (root / "other").mkdir()
        others = fleet_keys.make(rabit, root, ["uav1", "uav2"]) | fleet_keys.make(rabit, root / "other", ["stranger"])
        field.run(rabit, "keys", "add", "laptop", "--tool", "--keys", root / "keys")
        others["laptop"] = root / "keys" / "laptop"
        for number, (spoil, expected) in enumerate(CASES):
            folder = shutil.copytree(others["uav1"], root / str(number))
            spoil(folder, others)
            node = processes.start([ledger_node, "--node", "uav1", "--transport", transports[number % len(transports)], "--domain",
                                    harness.domain(), "--interface", "127.0.0.1", "--ledger", root / "ledger", "--keys", folder])
            code = node.exit_code(LIMIT_S)
            said = [text for _, text in node.lines]
            print(f"{expected}: exit code {code}, {said}")
            if code != 2 or len(said) != 1 or expected not in said[0]:
                failures.append(expected)
    print(f"{len(CASES)} folders, {len(failures)} failed: {failures}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
