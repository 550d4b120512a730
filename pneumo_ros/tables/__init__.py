"""Published tables as recordings: readers of their formats, maps of their columns, even clocks."""
