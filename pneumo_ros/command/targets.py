"""Where the recordings of several tables go: nothing is overwritten, and no two have one name."""

from collections.abc import Sequence
from pathlib import Path

from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_new_folder


def targets(tables: Sequence[str], out: str) -> dict[str, Path]:
    """For each table the folder of its recording: `out` itself for one table, where nothing is there yet.

    Else a folder named after the table in `out`. Raises UsageError where a recording would be overwritten or cannot be
    written.
    """
    from pneumo_ros.tables.formats.opening import table_name

    folder = Path(out)
    if len(tables) == 1 and not folder.exists():
        return {tables[0]: check_new_folder(folder)}
    if folder.is_file() or (folder / "metadata.yaml").exists():
        check_new_folder(folder)
    found = {table: folder / table_name(Path(table)) for table in tables}
    names = [path.name for path in found.values()]
    if twice := [table for table, path in found.items() if names.count(path.name) > 1]:
        raise UsageError(
            f"{' and '.join(twice)} would both become {found[twice[0]]}; import them one by one, each with its --out"
        )
    if folder.exists():
        for path in found.values():
            check_new_folder(path)
    else:
        check_new_folder(folder)
    return found
