"""A program that publishes numbered messages: `count` on each of `--topics` joint states and pressures, at `--rate`.

It waits until every topic has a subscriber, and prints how many it has published, every 20 messages and at the end.
"""

import argparse
import time
from contextlib import suppress

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import String

parser = argparse.ArgumentParser()
parser.add_argument("--count", type=int, required=True)
parser.add_argument("--rate", type=float, default=1000.0)
parser.add_argument("--namespace", default="/")
parser.add_argument(
    "--topics", nargs="*", default=["joint_states", "chamber_a/pressure", "chamber_b/pressure", "supply/pressure"]
)
parser.add_argument("--volatile-description", action="store_true")
options = parser.parse_args()

rclpy.init(args=[])
node = Node("publishes", namespace=options.namespace)
publishers = [
    (node.create_publisher(JointState if "joint" in topic else FluidPressure, topic, 10), "joint" in topic)
    for topic in options.topics
]
latched = (
    QoSProfile(depth=1)
    if options.volatile_description
    else QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
)
description = node.create_publisher(String, "description", latched)
description.publish(String(data='{"seed": 5}'))


def message(number: int, joint: bool) -> JointState | FluidPressure:
    """The message with this number, in its stamp and its value."""
    one = (
        JointState(name=["piston"], position=[float(number)]) if joint else FluidPressure(fluid_pressure=float(number))
    )
    one.header.stamp.sec, one.header.stamp.nanosec = divmod(number * 1_000_000, 1_000_000_000)
    return one


while not all(publisher.get_subscription_count() for publisher, _ in publishers):
    time.sleep(0.02)
if options.volatile_description:
    while not description.get_subscription_count():
        time.sleep(0.02)
    description.publish(String(data='{"seed": 6}'))
time.sleep(0.5)  # a subscriber finds its publisher later than it is found
start = time.monotonic()
for number in range(options.count):
    time.sleep(max(0.0, start + number / options.rate - time.monotonic()))
    for publisher, joint in publishers:
        publisher.publish(message(number, joint))
    if number % 20 == 19:
        print(number + 1, flush=True)
print(options.count, "published", flush=True)
with suppress(KeyboardInterrupt):
    time.sleep(60.0)  # latched messages live as long as their publisher
rclpy.try_shutdown()
