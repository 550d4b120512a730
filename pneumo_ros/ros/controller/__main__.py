"""`python -m pneumo_ros.ros.controller`."""

import sys

from pneumo_ros.ros.controller import main

sys.exit(main())
