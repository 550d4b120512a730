"""`pneumo identify`: static friction map, breakaways, flow and presliding from constant-voltage runs."""
