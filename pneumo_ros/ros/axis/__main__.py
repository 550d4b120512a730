"""`python -m pneumo_ros.ros.axis`."""

import sys

from pneumo_ros.ros.axis import main

sys.exit(main())
