"""What only `pneumo demo` needs: the axis on ROS 2, a machine that hides an effect, and whether it was found."""
