"""The reference part of the manual, written from the code: verbs, nodes, effects with pictures of what they leave."""
