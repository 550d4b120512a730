"""`python -m pneumo_ros.ros.commission`."""

import sys

from pneumo_ros.ros.commission import main

sys.exit(main())
