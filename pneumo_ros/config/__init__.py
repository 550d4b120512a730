"""Machine files, control files and layouts of other tools, in the package so that every installation has them."""
