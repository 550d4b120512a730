"""Readers of tables, one file each; `pneumo_ros.tables.reading` lists them."""
