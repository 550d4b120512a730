"""The equations of motion and of the chambers in weak form along measured signals, and breakaways."""
