"""A machine as a functional mock-up unit: description, sources, and the library for this computer in one archive."""

import io
import uuid
import zipfile

from pneumo_ros.export.building import binary_path, shared_library
from pneumo_ros.export.description import build_description, description
from pneumo_ros.export.machine import Exported
from pneumo_ros.export.unit_source import MAIN, unit_sources
from pneumo_ros.plant.machine_file import machine_text

VERSIONS = (3, 2)
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time an archive can hold: equal machines give equal files


def fmu_archive(machine: Exported, version: int) -> bytes:
    """The bytes of the .fmu file for FMI `version` 2 or 3.

    Raises UsageError for what C cannot say and without a compiler, PneumoError where the compiler fails.
    """
    text = machine_text(machine.model)
    token = "{" + str(uuid.uuid5(uuid.NAMESPACE_OID, f"{version}{text}{machine.model.composition.text}")) + "}"
    sources = unit_sources(machine, version, token)
    library = shared_library(sources, MAIN)
    content: dict[str, str | bytes] = {"modelDescription.xml": description(machine, version, token)}
    content |= {f"sources/{name}": source for name, source in sources.items()}
    if version == 3:
        content["sources/buildDescription.xml"] = build_description(machine.prefix)
    content["resources/machine.yaml"] = text
    content[binary_path(machine.prefix, version)] = library
    return _archive(content)


def _archive(content: dict[str, str | bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, data)
    return buffer.getvalue()
