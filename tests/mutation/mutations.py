#!/usr/bin/env python3
"""Breaks rules of classes that the simulations do not reach, one after the other, and shows that their tests notice.

    mutations.py --source REPOSITORY --build DIRECTORY --work DIRECTORY [--jobs 2] [--only TEXT]

For each mutation of the lists beside this file: the changed source is compiled and linked as the project's build does it
(BUILD, a ninja build in which the test programs are up to date; nothing in there is changed), into a program of its own,
and the tests named must fail. Exit status 1 if a mutation is not noticed, or does not fit the sources any more.

To add a class: entries in a list, with the path of the file and the program and filter of the tests that must notice. A
source in a library is linked before it; a header reaches the test program's own sources and those beside it.
"""

import argparse
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "simulation" / "common"))
import mutation  # noqa: E402
from air_list import MUTATIONS as AIR  # noqa: E402
from common_list import MUTATIONS as COMMON  # noqa: E402
from mirrors_list import MUTATIONS as MIRRORS  # noqa: E402
from transport_list import MUTATIONS as TRANSPORT  # noqa: E402

MUTATIONS = [*AIR, *MIRRORS, *TRANSPORT, *COMMON]
# Only keeps a hanging mutant from hanging the run. A mutant that hangs counts as noticed.
LIMIT_S = 120


class Commands:
    """How the build makes a test program."""

    def __init__(self, build):
        self.build = build
        self._known = {}

    def of(self, program):
        if program not in self._known:
            said = subprocess.run(["ninja", "-C", str(self.build), "-t", "commands", program], capture_output=True,
                                  text=True, check=True).stdout.splitlines()
            self._known[program] = [line for line in said if " -o " in line]
        return self._known[program]

    def compiling(self, program, source):
        """The command that makes an object of a source, and the object."""
        for line in self.of(program):
            words = shlex.split(line)
            if "-c" in words and Path(words[words.index("-c") + 1]).resolve() == source.resolve():
                return words, words[words.index("-o") + 1]
        raise RuntimeError(f"{program} is not made of {source}")

    def linking(self, program):
        line = next(line for line in reversed(self.of(program)) if re.search(rf" -o bin/{re.escape(program)}\b", line))
        # The commands around the link command are for other kinds of targets.
        line = re.sub(r"^: && ", "", re.sub(r" && .*$", "", re.sub(r"^: && ", "", line)))
        return shlex.split(line)

    def sources_of(self, program):
        """The program's own sources, not those of the libraries."""
        for line in self.of(program):
            words = shlex.split(line)
            if "-c" in words and f"/{program}.dir/" in words[words.index("-o") + 1]:
                yield Path(words[words.index("-c") + 1])


class Run:
    def __init__(self, source, build, work):
        self.source, self.work = source, work
        self.commands = Commands(build)
        self.build = build

    def execute(self, words):
        run = subprocess.run(words, cwd=self.build, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(f"it does not compile:\n{run.stderr[-2000:]}")

    def compile(self, program, source, changed, target):
        words, _ = self.commands.compiling(program, source)
        words[words.index("-c") + 1] = str(changed)
        words[words.index("-o") + 1] = str(target)
        for flag in ("-MF", "-MT"):
            if flag in words:
                words[words.index(flag) + 1] = str(target) + ".d"
        # The changed file finds its neighbours where the original finds them, unless they are changed too.
        words[words.index("-c"):words.index("-c")] = ["-iquote", str(changed.parent), f"-I{source.parent}", "-Wno-error"]
        self.execute(words)

    def mutant(self, change, number, program):
        """The program with the change in it."""
        work = self.work / f"mutant_{number}"
        work.mkdir(parents=True, exist_ok=True)
        source = self.source / change.file
        changed = work / source.name
        changed.write_text(mutation.apply(source.read_text(), change))
        # The file under both names by which others include it: alone, and with its folder.
        (work / source.parent.name).mkdir(exist_ok=True)
        (work / source.parent.name / source.name).write_text(changed.read_text())
        link = self.commands.linking(program)
        sources = [source]
        if source.suffix == ".h":
            sources = [each for each in [*self.commands.sources_of(program), *source.parent.glob("*.cpp")]
                       if re.search(rf'"({source.parent.name}/)?{source.name}"', each.read_text())]
            for each in sources:
                (work / each.name).write_text(each.read_text())
        for each in sources:
            target = work / (each.stem + ".o")
            self.compile(program, each, work / each.name, target)
            _, original = self.commands.compiling(program, each)
            if original in link:
                link[link.index(original)] = str(target)
            else:
                link.insert(next(i for i, word in enumerate(link) if word.endswith((".a", ".o"))), str(target))
        if not sources:
            raise RuntimeError(f"nothing in {program} includes it by its name alone")
        output = work / "program"
        link[link.index("-o") + 1] = str(output)
        self.execute(link)
        return output

    def judge(self, number, change):
        """What noticed, or why nothing did; and whether that is well."""
        program, _, tests = change.noticed_by.partition(":")
        try:
            path = self.mutant(change, number, program)
            run = subprocess.run([str(path), f"--gtest_filter={tests or '*'}", "--gtest_brief=1", "--gtest_fail_fast"],
                                 capture_output=True, text=True, timeout=LIMIT_S, cwd=self.build, check=False)
        except subprocess.TimeoutExpired:
            return True, "the tests do not end"
        except RuntimeError as error:
            return False, str(error)
        finally:
            (self.work / f"mutant_{number}" / "program").unlink(missing_ok=True)
        if run.returncode == 0:
            return False, "NOT NOTICED"
        failed = re.search(r"\[  FAILED  \] (\S+)", run.stdout)
        return True, failed.group(1) if failed else f"ended with status {run.returncode}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    run = Run(arguments.source.resolve(), arguments.build.resolve(), arguments.work.resolve())
    chosen = [change for change in MUTATIONS if arguments.only in f"{change.file} {change.name}"]
    missed = 0
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for change, (well, what) in zip(chosen, pool.map(run.judge, range(len(chosen)), chosen)):
            print(f"{'ok  ' if well else 'FAIL'} {Path(change.file).name}: {change.name}: {what}", flush=True)
            missed += not well
    print(f"{len(chosen) - missed} of {len(chosen)} noticed")
    sys.exit(1 if missed or not chosen else 0)


if __name__ == "__main__":
    main()
