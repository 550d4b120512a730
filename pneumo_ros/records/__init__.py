"""Recordings in and out: rosbag2 folders and MCAP files as arrays, and arrays as bags. No rclpy."""

from pneumo_ros.records.reading import read_recording
from pneumo_ros.records.recording import Recording
from pneumo_ros.records.topics import TopicData, read_topics

__all__ = ["Recording", "TopicData", "read_recording", "read_topics"]
