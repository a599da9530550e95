"""The program `rabit`."""

import os
import pathlib
import shutil


def program() -> str | None:
    """Beside this package, in the build tree, or in PATH."""
    here = pathlib.Path(__file__).resolve().parent
    beside = [here / "bin/rabit", pathlib.Path(__file__).parent.parent.parent / "bin/rabit"]
    return next((str(path) for path in beside if os.access(path, os.X_OK)), None) or shutil.which("rabit")


MISSING = "the program rabit is not installed: apt install rabit-tools"
