"""`python -m rabit` is the program rabit."""

import os
import pathlib
import shutil
import sys


def main() -> None:
    here = pathlib.Path(__file__).resolve().parent
    beside = [here / "bin/rabit", pathlib.Path(__file__).parent.parent.parent / "bin/rabit"]
    found = next((str(path) for path in beside if os.access(path, os.X_OK)), None) or shutil.which("rabit")
    if found is None:
        sys.exit("the program rabit is not installed: apt install rabit-tools")
    os.execv(found, [found, *sys.argv[1:]])


if __name__ == "__main__":
    main()
