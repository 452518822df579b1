"""python -m momentum_lab: the same as the command momentum-lab."""

import sys

from momentum_lab.cli import main

if __name__ == "__main__":
    sys.exit(main())
