import pathlib
import sys

sys.path[0] = str(pathlib.Path(__file__).resolve().parents[1])
# pylint: disable=wrong-import-position
from rabit_lab import main  # noqa: E402

sys.exit(main.main(sys.argv[1:]))
