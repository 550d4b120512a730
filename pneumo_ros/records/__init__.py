"""Recordings in and out: rosbag2 folders and MCAP files as arrays, and arrays as bags. No rclpy."""

from pneumo_ros.records.bag import Bag
from pneumo_ros.records.bag_writer import BagWriter
from pneumo_ros.records.metadata import BagTopic
from pneumo_ros.records.reading import read_recording
from pneumo_ros.records.recording import Recording
from pneumo_ros.records.topic_data import TopicData
from pneumo_ros.records.topics import read_topics
from pneumo_ros.records.writing import write_recording

__all__ = [
    "Bag",
    "BagTopic",
    "BagWriter",
    "Recording",
    "TopicData",
    "read_recording",
    "read_topics",
    "write_recording",
]
