"""Cylinders and valves as sold, each a file of figures with sources, and machine files made from them."""
