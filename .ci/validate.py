"""Whether a list of components keeps CycloneDX's schema:  python .ci/validate.py SBOM"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator


def main(sbom: Path) -> None:
    """Raises SystemExit where it does not."""
    text = sbom.read_text("utf-8")
    version = SchemaVersion.from_version(json.loads(text)["specVersion"])
    if fault := JsonStrictValidator(version).validate_str(text):
        raise SystemExit(f"{sbom}: {fault}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
