"""Imports every table of real machines: `python benchmarks/real/import_all.py TABLES OUT`, or PNEUMO_REAL for TABLES.

TABLES holds a folder for each map beside this file: mbari, xl330. OUT gets a folder of recordings for each of them.
"""

import argparse
import os
import sys
from pathlib import Path

from pneumo_ros.command.main import main

HERE = Path(__file__).parent


def import_all(tables: Path, out: Path) -> int:
    """Import the tables of each folder that has a map; the highest exit code of `pneumo import`."""
    codes = []
    for plan in sorted(HERE.glob("*.yaml")):
        found = sorted(str(path) for path in (tables / plan.stem).glob("*") if path.is_file())
        if found:
            out.mkdir(parents=True, exist_ok=True)
            codes.append(main(["import", *found, "--map", str(plan), "--out", str(out / plan.stem)]))
    if not codes:
        print(f"{tables} holds no folder that is named like a map of {HERE}", file=sys.stderr)
    return max(codes, default=2)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="?", default=os.environ.get("PNEUMO_REAL"), help="default: PNEUMO_REAL")
    parser.add_argument("out", nargs="?", default="real_bags", help="new folder (default: real_bags)")
    options = parser.parse_args()
    if options.tables is None:
        parser.error("name the folder of the tables, or set PNEUMO_REAL")
    sys.exit(import_all(Path(options.tables), Path(options.out)))
