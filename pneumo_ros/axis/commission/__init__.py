"""What the commissioning node does: its parameters become the command line of the verb, a process of its own."""
