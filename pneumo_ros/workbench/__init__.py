"""The local web page: it shows what the verbs write, and every computation in it is a verb that it runs."""
