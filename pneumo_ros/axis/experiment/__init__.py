"""What the experiment node does: prepare a programme and sort messages into recordings of its trials."""
