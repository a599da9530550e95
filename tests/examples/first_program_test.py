"""The README's first program is examples/two_nodes: each of its files is quoted there whole, under its name, and none
besides.

Usage: first_program_test.py ROOT
"""

import pathlib
import re
import sys

# `name`: and the block of text below it.
QUOTED = re.compile(r"^`(?P<name>[\w.]+)`:?\n\n```\w*\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
SECTION = "## The first program\n"


def main():
    root = pathlib.Path(sys.argv[1])
    readme = (root / "README.md").read_text()
    if SECTION not in readme:
        sys.exit(f"README.md has no section '{SECTION.strip()}'")
    section = readme.split(SECTION, 1)[1].split("\n## ", 1)[0]
    quoted = {match["name"]: match["text"] for match in QUOTED.finditer(section)}
    files = {file.name: file.read_text() for file in (root / "examples/two_nodes").iterdir()}
    wrong = [f"examples/two_nodes/{name} is not quoted in README.md" for name in sorted(files.keys() - quoted.keys())]
    wrong += [f"README.md quotes {name}, which examples/two_nodes has not" for name in sorted(quoted.keys() - files.keys())]
    wrong += [f"README.md quotes another {name} than examples/two_nodes has"
              for name in sorted(files.keys() & quoted.keys()) if files[name] != quoted[name]]
    print("\n".join(wrong or [f"{len(files)} files are the same"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
