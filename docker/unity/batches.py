#!/usr/bin/env python3
"""Says which sources of a target are compiled together, as one unit.

Usage: batches.py SIZE LIST
LIST has one line for each source: its target, its folder in the source tree, and its path, separated by tabs. Prints
CMake commands that give the sources their UNITY_GROUP, each group with about SIZE sources.

What is in an anonymous namespace, and a name that is `static`, is a file's own; two files of one unit must not have the
same in one namespace. So sources that define a name alike are put into different groups, those that use a name which another one
defines as a macro, and those that have the names of different namespaces by `using`. A source that goes with none is compiled alone. The sources are read roughly, as their layout by
clang-format allows; where that does not do, the compiler says "redefinition", and SKIP_UNITY_BUILD_INCLUSION on the
source helps.
"""

import pathlib
import re
import sys

IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
# Comments and literals, which define no names. A quote within a number begins no literal.
IGNORED = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<d>[^(\s]*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])*\'',
                     re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.)*(?:\\\n(?:[^\n\\]|\\.)*)*", re.M | re.S)
TOKEN = re.compile(r"[A-Za-z_]\w*|::|\[\[.*?\]\]|\S", re.S)
KINDS = {"class", "struct", "union", "enum"}
GTEST = re.compile(r"^TEST(_F|_P)?$|^TYPED_TEST(_P)?$")


class Source:
    """What a source file defines."""

    def __init__(self, text):
        text = IGNORED.sub(lambda found: " " + "\n" * found.group().count("\n"), text)
        self.macros = set(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", text, re.M))
        self.mentioned = set(IDENTIFIER.findall(text))
        # Those of a function, which are indented, end with it; literals have no names that could mean something else.
        self.directives = set(re.findall(r"^(?:namespace\b[^\n]*)?using\s+namespace\s+((?!std::\w*literals\b)[\w:]+)", text, re.M))
        # The names that `using` brings in: last part to full name.
        self.brought = dict((name.split("::")[-1], name.removeprefix("::"))
                            for name in re.findall(r"\busing\s+([\w:]+::\w+)\s*;", text))
        self.defined = set()  # names with their namespaces; one without a name does not count
        self.names = set()  # the same names alone
        self.aliases = {}  # what those of the defined names stand for that are aliases of types or namespaces
        self.namespaces = []  # where the reader is
        self.read(TOKEN.findall(DIRECTIVE.sub(" ", text)))

    def read(self, tokens):
        """Adds the names that are defined in namespaces; what is within braces of other kinds is left out."""
        statement = []
        at = 0
        while at < len(tokens):
            token = tokens[at]
            if token == "{":
                if "namespace" in statement or statement[:1] == ["extern"] and len(statement) == 1:
                    self.namespaces.append("".join(word for word in statement if word not in ("namespace", "inline", "extern")))
                    statement = []
                else:
                    at, within = self.skip(tokens, at)
                    if statement[:1] == ["enum"] and statement[1:2] not in (["class"], ["struct"]):
                        for name in re.findall(r"(?:^|,)\s*([A-Za-z_]\w*)", " ".join(within)):
                            self.add(name)
                    statement.append("{}")
                    # A function ends here; a type and a value end with the semicolon.
                    if self.ends_with_body(statement):
                        self.define(statement)
                        statement = []
            elif token == ";":
                self.define(statement)
                statement = []
            elif token == "}":
                del self.namespaces[-1:]
                statement = []
            else:
                statement.append(token)
            at += 1

    def add(self, name):
        """Returns the name with its namespaces."""
        self.names.add(name)
        full = "::".join([one for one in self.namespaces if one] + [name])
        self.defined.add(full)
        return full

    @staticmethod
    def skip(tokens, at):
        """The place of the brace that closes the one at a place, and what is between them."""
        depth = 0
        for place in range(at, len(tokens)):
            depth += (tokens[place] == "{") - (tokens[place] == "}")
            if depth == 0:
                return place, tokens[at + 1:place]
        return len(tokens) - 1, tokens[at + 1:]

    @staticmethod
    def ends_with_body(statement):
        return "(" in statement and "=" not in statement and not KINDS & set(statement[:1])

    def define(self, statement):
        words = [word for word in statement if not word.startswith("[[")]
        is_template = words[:1] == ["template"]
        words = without_template(words)
        if not words or words[0] == ",":  # the rest of a constructor's initializers
            return
        if GTEST.match(words[0]) and words[1:2] == ["("]:
            self.add("_".join(word for word in words[2:words.index(")")] if word != ",") + "_Test")
        elif words[0] in ("using", "namespace"):
            if words[2:3] == ["="]:
                name = self.add(words[1])
                if not is_template:
                    self.aliases[name] = words[2:]
        elif words[0] in KINDS:
            name = next((word for word in words[1:] if IDENTIFIER.fullmatch(word) and word not in KINDS), None)
            if name and words[-1] != name:  # not a mere declaration
                self.add(name)
        elif words[0] == "typedef":
            self.add(words[-1])
        else:
            self.define_by_declarator(words)

    def define_by_declarator(self, words):
        """A function's or a value's name is before the first parenthesis, bracket, brace or =, outside of <>."""
        depth = 0
        for at, word in enumerate(words):
            depth += (word == "<") - (word == ">")
            if depth == 0 and word in ("(", "=", "{}", "["):
                # A word with no word before it is a macro; a word after :: is a member that was declared
                # elsewhere.
                if at >= 2 and IDENTIFIER.fullmatch(words[at - 1]) and words[at - 2] != "::":
                    self.add(words[at - 1])
                return
        if len(words) >= 2 and IDENTIFIER.fullmatch(words[-1]) and words[-2] != "::":
            self.add(words[-1])

    def goes_with(self, other):
        if self.directives and other.directives and self.directives != other.directives:
            return False
        if any(other.brought.get(name, full) != full for name, full in self.brought.items()):
            return False
        if self.names & set(other.brought) or set(self.brought) & other.names:
            return False
        # The same alias twice is no error.
        if any(name not in self.aliases or self.aliases[name] != other.aliases.get(name)
               for name in self.defined & other.defined):
            return False
        return not (self.macros & other.mentioned or other.macros & self.mentioned)


def without_template(words):
    while words[:2] == ["template", "<"]:
        depth = 0
        for at, word in enumerate(words):
            depth += (word == "<") - (word == ">")
            if at > 0 and depth == 0:
                words = words[at + 1:]
                break
        else:
            return []
    return words


def batches(sources, most):
    """Names of sources in groups that go together, from a dictionary of Source by name; in their order."""
    groups = []
    for name, source in sources.items():
        for group in groups:
            if len(group) < most and all(source.goes_with(sources[other]) for other in group):
                group.append(name)
                break
        else:
            groups.append([name])
    return groups


def size(count, about):
    """How many of the sources of a target are compiled as one: the groups are of one size, so that no source is left over."""
    groups = max(1, round(count / about))
    return -(-count // groups)


def source_of(path):
    # Generated messages define names of their own types alone, and may not exist yet.
    return Source("" if path.name.endswith(".idl.cpp") else path.read_text())


def main():
    about = int(sys.argv[1])
    targets = {}
    for line in pathlib.Path(sys.argv[2]).read_text().splitlines():
        target, folder, path = line.split("\t")
        targets.setdefault((target, folder), []).append(path)
    owners = {}
    for (target, folder), paths in targets.items():
        for path in paths:
            owners.setdefault((folder, path), []).append(target)
    for (target, folder), paths in targets.items():
        # UNITY_GROUP is a property of a source in a folder, so a source shared by several targets of that
        # folder gets no group.
        own = {path: source_of(pathlib.Path(folder) / path) for path in paths if len(owners[folder, path]) == 1}
        grouped = [group for group in batches(own, size(len(own), about)) if len(group) > 1]
        for number, group in enumerate(grouped):
            files = " ".join(f'"{pathlib.Path(folder) / path}"' for path in group)
            print(f"set_property(SOURCE {files} TARGET_DIRECTORY {target} PROPERTY UNITY_GROUP {number})")
        if grouped:
            print(f"set_target_properties({target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)")


if __name__ == "__main__":
    main()
