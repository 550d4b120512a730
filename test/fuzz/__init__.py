"""Bad input for every parser of the package: damaged files, invalid documents, and the rules for an answer."""
