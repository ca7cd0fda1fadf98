"""What isatools finds in ISA-JSON: `python docs/scripts/isa_findings.py upload/i_investigation.json`.

isatools 0.14 wants older numpy and pandas than siggen's constraints, so it gets an environment of its own:

    python3 -m venv isa && isa/bin/python -m pip install isatools==0.14.3

Two findings are of isatools, not of the file, and are counted apart: there is no configuration for vibration (4002: its
configurations are those of the life sciences), and a parameter of microarrays that no file declares (1020).
"""

from __future__ import annotations

import json
import logging
import sys
from collections import Counter
from pathlib import Path

NO_CONFIGURATION, UNUSED_PARAMETER = 4002, 1020
OF_MICROARRAYS = "#parameter/Array_Design_REF"


def own(finding: dict[str, object]) -> bool:
    """Return whether a finding is one of isatools itself."""
    text = str(finding["supplemental"])
    if finding["code"] == UNUSED_PARAMETER:
        return text.count("#") == 1 and OF_MICROARRAYS in text
    return finding["code"] == NO_CONFIGURATION and text.startswith("Measurement vibration/")


def main(path: Path) -> int:
    """Print studies and assays as isatools loads them, and every finding; return 1 if one is of the file."""
    from isatools import isajson

    logging.getLogger("isatools").propagate = False
    with path.open(encoding="utf-8") as file:
        found = isajson.validate(file)
    with path.open(encoding="utf-8") as file:
        studies = isajson.load(file).studies
    findings = [*found["errors"], *found["warnings"]]
    print(json.dumps({"studies": len(studies), "assays": sum(len(study.assays) for study in studies)}))
    print(json.dumps({"of isatools": Counter(finding["code"] for finding in findings if own(finding))}))
    of_file = [finding for finding in findings if not own(finding)]
    print(json.dumps({"of the file": of_file}))
    return 1 if of_file else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
