import sys

from rabit_lab import main

sys.exit(main.main(sys.argv[1:]))
