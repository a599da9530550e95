"""The commands on a page of the manual run, and print what the page says.

Each ```console block has a comment above it:
    <!-- run -->                   its commands end with 0, and print these lines
    <!-- run: exit code 3 -->      its last command ends with 3
    <!-- run: until it is so -->   the same; they run again while they print something else, since nodes meet in their own time
    <!-- setup -->                 its commands hold for all later blocks: variables of the environment
    <!-- background: sensor -->    its command goes on; the test waits until it has printed these lines
    <!-- stop: sensor, display --> before what follows, these are told to end, and do so in order
    <!-- not run: why -->          it cannot be run here
Lines that differ in numbers alone count as the same, since times, rates and sizes are not those of the page. A line of the
page may be the beginning of the printed one.

The commands run in a folder like that of the sources, in a network of their own; they are skipped where there is none.

Usage: guide_test.py ROOT BIN PAGE...
"""

import contextlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "integration"))
import harness  # noqa: E402

BLOCK = re.compile(r"(?P<comments>(?:^<!-- [^\n]* -->\n)*)^```console\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
COMMENT = re.compile(r"^<!-- (?P<what>[a-z ]+?)(?:: (?P<more>.*?))? -->$", re.MULTILINE)
KNOWN = {"run", "setup", "background", "stop", "not run"}
# Only keeps a broken test from hanging.
LIMIT_S = 300
NOT_HEARD = 3


def plain(line):
    """A line without its numbers, with their units, and without the width of its columns. `-` is a number not known."""
    numbers = re.sub(r"-?\d[\d.]*(e-?\d+)?( (ms|s|B/s|Hz)\b)?|(?<= )-(?= |$)", "N", line)
    return re.sub(r" +", " ", numbers).strip()


def commands_of(text):
    """[(command, lines that it prints)]"""
    commands = []
    for line in text.splitlines():
        if line.startswith("$ "):
            commands.append((line[2:], []))
        elif line.strip() != "...":
            commands[-1][1].append(line)
    return commands


def missing_of(wanted, printed):
    """The first wanted line that was not printed, in this order; empty if all were."""
    lines = iter([plain(line) for line in printed])
    for line in wanted:
        if not any(one.startswith(plain(line)) for one in lines):
            return line
    return ""


class Guide:
    def __init__(self, page, programs, folder, processes):
        self.page, self.folder, self.processes = page, folder, processes
        self.environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        self.running, self.ran = {}, 0

    def fail(self, command, what):
        sys.exit(f"FAILED: {self.page.name}: $ {command}\n{what}")

    def follow(self):
        for block in BLOCK.finditer(self.page.read_text()):
            kinds = COMMENT.findall(block["comments"])
            if not kinds or any(kind not in KNOWN for kind, _ in kinds):
                self.fail(block["text"].splitlines()[0], "no comment above it says whether it runs")
            for kind, more in kinds:
                getattr(self, kind.replace(" ", "_"))(commands_of(block["text"]), more)

    def not_run(self, _, why):
        assert why, "a reason"

    def setup(self, commands, _):
        for command, _ in commands:
            name, _, value = command.removeprefix("export ").partition("=")
            self.environment[name] = value

    def wrong_with(self, command, wanted, code):
        """What the command does that the page does not say, and its exit code; empty if it does what the page says."""
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, timeout=LIMIT_S,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        missing = missing_of(wanted, done.stdout.splitlines())
        what = f"did not print: {missing}" if missing else f"exit code {done.returncode}, not {code}"
        return f"{what}\n{done.stdout}" if missing or done.returncode != code else "", done.returncode

    def run(self, commands, more):
        codes = [0] * len(commands)
        if more.startswith("exit code "):
            codes[-1] = int(more.removeprefix("exit code "))
        for (command, wanted), code in zip(commands, codes):
            last = []

            # A command may not have heard nodes in the time that it gives them.
            def is_decided(command=command, wanted=wanted, code=code, last=last):
                last[:] = self.wrong_with(command, wanted, code)
                return not last[0] or (more != "until it is so" and last[1] != NOT_HEARD)

            with contextlib.suppress(AssertionError):  # told below
                harness.until(is_decided, LIMIT_S)
            if last[0]:
                self.fail(command, last[0])
            self.ran += 1

    def background(self, commands, name):
        (command, wanted), = commands
        words = command.split()
        process = self.processes.start([self.folder / words[0], *words[1:]])
        self.running[name] = process
        for line in wanted:
            process.wait_for(lambda printed, line=line: plain(printed).startswith(plain(line)), LIMIT_S)
        self.ran += 1

    def stop(self, _, names):
        for name in names.split(", "):
            if self.running.pop(name).terminate() != 0:
                self.fail(name, "it did not end in order")


def main():
    root, programs, pages = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3:]
    harness.enter_namespace_or_skip()
    for page in pages:
        with tempfile.TemporaryDirectory(prefix="rabit_guide_") as folder, harness.Processes() as processes:
            folder = pathlib.Path(folder)
            shutil.copytree(root / "examples/two_nodes", folder / "examples/two_nodes")
            (folder / "build/release").mkdir(parents=True)
            (folder / "build/release/bin").symlink_to(programs)
            os.chdir(folder)
            guide = Guide(root / page, programs, folder, processes)
            guide.follow()
            print(f"ok: {page}: {guide.ran} commands")
    return 0


if __name__ == "__main__":
    sys.exit(main())
