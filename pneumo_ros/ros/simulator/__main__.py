"""`python -m pneumo_ros.ros.simulator`."""

import sys

from pneumo_ros.ros.simulator.entry import main

sys.exit(main())
