"""A diagnosis in words: sentences and tables from its JSON; terminal, report and workbench only lay them out."""
