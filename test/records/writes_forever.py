"""A program to be killed: writes numbered messages into a bag at about 2 kHz and prints when each is written."""

import sys
import time
from itertools import count

import numpy as np

from pneumo_ros.records import BagTopic, BagWriter
from pneumo_ros.records.encoding import numbers

with BagWriter(sys.argv[1], [BagTopic("/n", "std_msgs/msg/Float64")]) as writer:
    for number in count():
        writer.write("/n", time.time_ns(), numbers(np.array([float(number)]))[0])
        if number % 20 == 0:
            print(number, flush=True)
            time.sleep(0.01)
