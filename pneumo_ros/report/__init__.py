"""One self-contained HTML page from the JSON of a verb and the series beside it."""
