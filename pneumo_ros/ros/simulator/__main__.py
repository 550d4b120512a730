"""`python -m pneumo_ros.ros.simulator`."""

import sys

from pneumo_ros.ros.simulator import main

sys.exit(main())
