"""`python -m rabit` is the program rabit."""

import os
import sys

from . import _tool


def main() -> None:
    found = _tool.program()
    if found is None:
        sys.exit(_tool.MISSING)
    os.execv(found, [found, *sys.argv[1:]])


if __name__ == "__main__":
    main()
