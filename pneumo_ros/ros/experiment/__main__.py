"""`python -m pneumo_ros.ros.experiment`."""

import sys

from pneumo_ros.ros.experiment import main

sys.exit(main())
