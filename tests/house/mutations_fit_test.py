#!/usr/bin/env python3
"""Every rule that the mutation tests break is still in the sources, once: those tests take too long to be run with each change,
and one that does not fit any more tests nothing.

Usage: mutations_fit_test.py REPOSITORY"""

import importlib.util
import pathlib
import sys

# The directories whose lists name only the file, and the folders of such files.
SIMULATIONS = {"tests/simulation/links": ["gateway/links"], "tests/simulation/fleet": ["gateway"]}


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.MUTATIONS


def files_of(root, listed, name):
    folder = listed.parent.relative_to(root).as_posix()
    if folder not in SIMULATIONS:
        return [root / name]
    return [found for below in SIMULATIONS[folder] for found in (root / below).rglob(name)]


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    sys.path.insert(0, str(root / "tests/simulation/common"))
    import mutation
    wrong = []
    count = 0
    lists = [*root.glob("tests/mutation/*_list.py"), *root.glob("tests/simulation/*/mutation_list.py")]
    for listed in sorted(lists):
        for each in load(listed):
            count += 1
            try:
                file, = files_of(root, listed, each.file)
                mutation.apply(file.read_text(encoding="utf-8"), each)
            except (RuntimeError, ValueError, OSError) as error:
                wrong.append(f"{listed.relative_to(root)}: {each.name}: {error}")
    print("\n".join(wrong) if wrong else f"{count} fit")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
