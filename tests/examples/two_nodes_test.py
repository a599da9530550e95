"""examples/two_nodes as a user runs it: the nodes talk, over each pair of backends; what is wrong with a configuration
is one line and exit code 2; Ctrl-C ends a node in order.

Usage: two_nodes_test.py BIN ROOT TRANSPORT,... [EMULATOR]
The emulator runs the programs if they are of another processor.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

# Only keeps a broken test from hanging.
LIMIT_S = 300
EMULATOR = sys.argv[4:]


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")
    print(f"ok: {what}")


def talk(programs, folder, first, second):
    with harness.Processes() as processes:
        def start(name, transport):
            return processes.start([*EMULATOR, programs / name, "--config", folder / f"{name}.yaml", "--transport", transport,
                                    "--domain", harness.domain()])
        display = start("display", second)
        sensor = start("sensor", first)
        display.wait_for(re.compile(r"^reading \d+: [\d.]+ C, [\d.e-]+ s old$").search, LIMIT_S)
        display.wait_for(re.compile(r"^calibration delivered$").search, LIMIT_S)
        sensor.wait_for(re.compile(r"^calibrated by -0\.5 C$").search, LIMIT_S)
        for node in sensor, display:
            check(node.terminate() == 0, f"{node.argv[0]} ends in order")
    print(f"ok: sensor over {first}, display over {second}")


def refused(programs, folder, name, text, line):
    """Also by --check, and without starting anything."""
    (folder / "wrong.yaml").write_text(text)
    for extra in [], ["--check"]:
        done = subprocess.run([*EMULATOR, programs / name, "--config", folder / "wrong.yaml", *extra], capture_output=True,
                              text=True, timeout=LIMIT_S, check=False)
        check(done.returncode == 2, f"exit code 2 for {text!r} {extra}")
        check(done.stdout == "" and done.stderr == f"{folder}/wrong.yaml:{line}\n", f"one line, {done.stderr!r}")


def main():
    programs, root, transports = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
    harness.enter_namespace()
    with tempfile.TemporaryDirectory(prefix="rabit_two_nodes_") as folder:
        folder = pathlib.Path(folder)
        for name in "sensor", "display":
            text = (root / f"examples/two_nodes/{name}.yaml").read_text()
            (folder / f"{name}.yaml").write_text(text + "interfaces: [lo]\n")
        refused(programs, folder, "sensor", "node: sensor\npublish:\n  - {message: Reading, type: TwoNodes::Readin}\n",
                "3: unknown IDL type `TwoNodes::Readin`; did you mean `TwoNodes::Reading`?")
        refused(programs, folder, "display", "node: display\ndomian: 7\n",
                "2: unknown key `domian` in the configuration; did you mean `domain`?")
        missing = subprocess.run([*EMULATOR, programs / "sensor", "--config", folder / "none.yaml"], capture_output=True, text=True,
                                 timeout=LIMIT_S, check=False)
        check(missing.returncode == 2 and missing.stderr.count("\n") == 1, f"no file: {missing.stderr!r}")
        for first in transports:
            for second in transports:
                talk(programs, folder, first, second)


if __name__ == "__main__":
    main()
