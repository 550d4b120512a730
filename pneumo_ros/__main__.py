"""`python -m pneumo_ros` is `pneumo`."""

import sys

from pneumo_ros.command.main import main

sys.exit(main())
