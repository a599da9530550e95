"""Test programs with a change in one source, compiled and linked as the project's build does it."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "simulation" / "common"))
import mutation  # noqa: E402


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
        """The command that makes an object of a source, or of the batch that it is in, what is compiled, and the object."""
        for line in self.of(program):
            words = shlex.split(line)
            if "-c" not in words:
                continue
            unit = Path(words[words.index("-c") + 1])
            if source.resolve() in map(Path.resolve, files_of(unit)):
                return words, unit, words[words.index("-o") + 1]
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
                yield from files_of(Path(words[words.index("-c") + 1]))


def files_of(unit):
    """The sources of a unit: itself, or if it is a batch the files that it includes."""
    if not re.fullmatch(r"unity_\d+_cxx\.cxx", unit.name):
        return [unit]
    return [Path(name) for name in re.findall(r'^#include "(.+)"', unit.read_text(), re.M)]


def overlay(source, tree, file, text):
    """Makes a tree that is the source tree, with that text in the file: of links but for the folders above the file."""
    here, there = source, tree
    for part in Path(file).parts:
        there.mkdir(parents=True)
        for each in here.iterdir():
            if each.name != part:
                (there / each.name).symlink_to(each)
        here, there = here / part, there / part
    there.write_text(text)


class Mutants:
    def __init__(self, source, build, work):
        self.source, self.work = source, work
        self.commands = Commands(build)
        self.build = build

    def execute(self, words):
        run = subprocess.run(words, cwd=self.build, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise RuntimeError(f"it does not compile:\n{run.stderr[-2000:]}")

    def moved(self, text, tree):
        """The text with the paths of sources as those of the tree."""
        generated = f"{self.build}/"
        return text.replace(generated, "\0").replace(f"{self.source}/", f"{tree}/").replace("\0", generated)

    def compile(self, words, unit, tree, target):
        """Compiles a unit from the tree."""
        words = [self.moved(word, tree) for word in words]
        if files_of(unit) != [unit]:
            batch = target.with_suffix(".cxx")
            batch.write_text(self.moved(unit.read_text(), tree))
            words[words.index("-c") + 1] = str(batch)
        words[words.index("-o") + 1] = str(target)
        for flag in ("-MF", "-MT"):
            if flag in words:
                words[words.index(flag) + 1] = str(target) + ".d"
        self.execute([*words, "-Wno-error"])

    def mutant(self, change, number, program):
        """The program with the change in it."""
        work = self.work / f"mutant_{number}"
        shutil.rmtree(work, ignore_errors=True)
        file = os.path.normpath(change.file)
        source = self.source / file
        tree = work / "tree"
        overlay(self.source, tree, file, mutation.apply(source.read_text(), change))
        link = self.commands.linking(program)
        sources = [source]
        if source.suffix == ".h":
            sources = [each for each in [*self.commands.sources_of(program), *source.parent.glob("*.cpp")]
                       if re.search(rf'"({source.parent.name}/)?{source.name}"', each.read_text())]
        if not sources:
            raise RuntimeError(f"nothing in {program} includes it by its name alone")
        units = {original: (words, unit) for words, unit, original in (self.commands.compiling(program, each) for each in sources)}
        for index, (original, (words, unit)) in enumerate(units.items()):
            target = work / f"{index}.o"
            self.compile(words, unit, tree, target)
            if original in link:
                link[link.index(original)] = str(target)
            else:
                link.insert(next(i for i, word in enumerate(link) if word.endswith((".a", ".o"))), str(target))
        output = work / "program"
        link[link.index("-o") + 1] = str(output)
        self.execute(link)
        return output
