"""`python test/rig --out DIR`: record a machine that hides an effect."""

import sys
from pathlib import Path

if not __package__:  # run as a folder: its parent contains the package
    sys.path[0] = str(Path(__file__).resolve().parents[1])

from rig.command import main

sys.exit(main())
