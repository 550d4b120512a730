"""What a node does, without ROS: step the plant, guide the piston, watch recordings, and the parameters of each."""
