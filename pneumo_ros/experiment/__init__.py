"""What to make a plant do so that its recordings tell something: programmes, and who conducts them. No ROS."""
