"""The README of examples/two_nodes, the first program, quotes each file of the folder whole, under its name, and none
besides. The top README leads to it.

Usage: first_program_test.py ROOT
"""

import pathlib
import re
import sys

# `name`: and the block of text below it.
QUOTED = re.compile(r"^`(?P<name>[\w.]+)`:?\n\n```\w*\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
FOLDER = "examples/two_nodes"


def main():
    root = pathlib.Path(sys.argv[1])
    files = {file.name: file.read_text() for file in (root / FOLDER).iterdir()}
    readme = files.pop("README.md")
    quoted = {match["name"]: match["text"] for match in QUOTED.finditer(readme)}
    wrong = [f"{FOLDER}/{name} is not quoted in its README.md" for name in sorted(files.keys() - quoted.keys())]
    wrong += [f"{FOLDER}/README.md quotes {name}, which the folder has not"
              for name in sorted(quoted.keys() - files.keys())]
    wrong += [f"{FOLDER}/README.md quotes another {name} than the folder has"
              for name in sorted(files.keys() & quoted.keys()) if files[name] != quoted[name]]
    if f"({FOLDER}/README.md)" not in (root / "README.md").read_text():
        wrong.append(f"README.md does not lead to {FOLDER}/README.md")
    print("\n".join(wrong or [f"{len(files)} files are the same"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
