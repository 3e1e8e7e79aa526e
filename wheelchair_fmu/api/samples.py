"""The bundled examples, as files of a user's own."""

from __future__ import annotations

from pathlib import Path

from ..errors import Failure, unknown
from ..resources import EXAMPLES
from ..writing import written

# What there is, and the files of each in the folder of examples.
SAMPLES = {
    "campaign": ("sample-campaign/campaign.toml", "sample-campaign/runs/*.csv"),
    "tyre": ("rotating-disc.csv",),
    "sweep": ("sweep.toml",),
    "inputs": ("push.csv", "turn.csv", "slalom.csv"),
}


def sample(folder: str | Path, kind: str = "campaign") -> tuple[Path, ...]:
    """Unpack an example into `folder` and return the files, the first of which names the others.

    `kind` is "campaign" (ten runs of a simulated chair, in which one effect is hidden), "tyre" (rig data of two tyres), "sweep"
    (the plan of one) or "inputs" (push forces for `fmpy simulate --input-file`).

    Raises UsageError for an unknown kind, and Failure where a file is there already.

    >>> [file.name for file in wc.sample("my-campaign")][:2]
    ['campaign.toml', 'coast-down.csv']
    """
    if kind not in SAMPLES:
        raise unknown("sample", kind, SAMPLES)
    sources = [file for pattern in SAMPLES[kind] for file in sorted(EXAMPLES.glob(pattern))]
    top = (EXAMPLES / SAMPLES[kind][0]).parent
    targets = [Path(folder) / file.relative_to(top) for file in sources]
    for target in targets:
        if target.exists():
            raise Failure(f"{target}: is there already; give a new folder")
    for source, target in zip(sources, targets, strict=True):
        with written(target) as beside:
            beside.write_bytes(source.read_bytes())
    return tuple(targets)
