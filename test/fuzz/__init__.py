"""Bad input for every parser of the package: damaged files, grammars of nonsense, and what an answer must be."""
