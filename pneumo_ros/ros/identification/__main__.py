"""`python -m pneumo_ros.ros.identification`."""

import sys

from pneumo_ros.ros.identification import main

sys.exit(main())
