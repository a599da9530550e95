#!/usr/bin/env python3
"""Builds the manual: static pages, which a browser shows without a web server.

Usage: build.py ROOT OUT BIN VERSION
OUT/html: the pages; html/index.html is the first. OUT/source: a copy of all pages with those that are generated from
the programs in BIN. Exit code 77 and a line if Sphinx or Doxygen is missing.
"""

import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "generate"))
import api  # noqa: E402
import commands  # noqa: E402
import pages  # noqa: E402
import theme  # noqa: E402


def run_in_python_of_sphinx(code):
    """What the code prints in the Python that Sphinx runs in, which need not be the first of PATH; None: it fails."""
    python = pathlib.Path(shutil.which("sphinx-build")).read_text().partition("\n")[0].removeprefix("#!")
    done = subprocess.run([*python.split(), "-c", code], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def missing_tools():
    missing = [tool for tool in ("doxygen", "sphinx-build") if shutil.which(tool) is None]
    if not api.AWESOME.exists():
        missing.append("doxygen-awesome-css")
    if not missing and run_in_python_of_sphinx("import furo, myst_parser, sphinx_copybutton") is None:
        missing = ["furo, myst_parser or sphinx_copybutton"]
    return missing


def main():
    root, out, programs, version = (*map(pathlib.Path, sys.argv[1:4]), sys.argv[4])
    missing = missing_tools()
    if missing:
        print(f"skipped: the manual needs {', '.join(missing)}; install the packages of docker/packages-manual.txt")
        return 77
    source, html = out / "source", out / "html"
    for folder in source, html:
        shutil.rmtree(folder, ignore_errors=True)
    pages.copy(root, source)
    furo = run_in_python_of_sphinx("import furo, os; print(os.path.dirname(furo.__file__))")
    theme.mend(furo, source / "docs/static")
    reference = source / "docs/reference"
    commands.write(programs / "rabit", reference / "commands")
    keys = subprocess.run([programs / "config_reference"], capture_output=True, text=True, check=True).stdout
    page = reference / "configuration.md"
    page.write_text(page.read_text() + keys)
    tags = api.write(root, out, html / "api", version)
    environment = {**os.environ, "RABIT_TAGS": str(tags), "RABIT_VERSION": version}
    done = subprocess.run(["sphinx-build", "-q", "-W", "--keep-going", "-j", "auto", "-c", source / "docs", source, html],
                          env=environment, check=False)
    (html / "index.html").write_text('<!doctype html><meta charset="utf-8"><title>Rabit</title>'
                                     '<meta http-equiv="refresh" content="0; url=docs/index.html">'
                                     '<a href="docs/index.html">The manual</a>\n')
    print(html / "index.html")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
