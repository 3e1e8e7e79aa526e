"""From a source to an .ssp: three FMUs, what connects them, and parameter sets.

An archive holds two descriptions of one system. SystemStructure.ssd is plain: components, connections, and one parameter set
for each component, which is what every importer reads; libcosim stops at a connection to the system itself and takes the
first set of a component only. Interface.ssd is the same system with connectors of its own, for use inside another, and
with handles: a few parameters in everyday units, which a mapping takes to the components.

Some importers read no parameter sets, so the FMUs start with the values that the sets give. FMPy sets every input that is
listed as a connector, to zero where nothing feeds it; so inputs that nothing feeds are not listed.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from ...fmu import package, parameter_set
from ...fmu.companions import Recording, build_floor, build_pusher
from ...fmu.documentation import LICENCE
from ...fmu.parameter_set import ParameterSet
from ...model.former import current
from ...model.variant import Variant
from ..archives import fmu_of
from . import checking, sources, writing
from .page import page
from .records import MAIN
from .structure import FMUS, Model, plain_system, usual_file, with_interface

INTERFACE = "Interface.ssd"
BOUND = "initialValues"  # what the bound sets are called: Ecos applies sets of one name together, and its examples this one


def build(
    name: str = "slalom",
    target: Path | None = None,
    *,
    version: str = "1",
    variant: Variant | None = None,
    parameters: Iterable[str] = (),
    recording: Recording | None = None,
) -> Path:
    """Build the archive of a system, by its name in ssp/systems or by a file, and return its path.

    `parameters` are sets by name or file that go on top of Table 1 and of the variant's values. With a recording the pusher
    replays it. Raises UsageError for an unknown name, and Failure where something cannot be built or is not valid.
    """
    written_as = sources.version(version)
    source = sources.system(name)
    if recording:
        source = replace(source, title="Recorded pushes, replayed")
    chair = variant or Variant()
    source = replace(source, values={**source.values, "Chair": current(source.values["Chair"], chair.values)})
    chair = chair.with_values(source.values["Chair"])  # which may switch effects on
    sets = _bound(source, chair, parameters)
    with TemporaryDirectory() as folder:
        models = {c: Model.of(f) for c, f in _fmus(Path(folder), sets, chair, recording).items()}
    path = target or Path("dist") / usual_file(source.name)
    files = _files(source, models, sets, written_as)
    return package.write(path, files, lambda made: [str(fault) for fault in checking.check(made)])


def _fmus(folder: Path, sets: dict[str, ParameterSet], chair: Variant, recording: Recording | None) -> dict[str, Path]:
    """The FMUs, which start with the values of the sets."""
    starts = {c: {name: s.value for name, s in bound.settings.items()} for c, bound in sets.items()}
    if recording:
        starts["Pusher"]["pusher.mode"] = "replay"
    return {
        "Chair": fmu_of(chair.with_values(starts["Chair"]), with_starts=True),
        "Pusher": build_pusher(folder / "Pusher.fmu", starts["Pusher"], recording),
        "Floor": build_floor(folder / "Floor.fmu", starts["Floor"]),
    }


def _bound(source: sources.Source, chair: Variant, chosen: Iterable[str]) -> dict[str, ParameterSet]:
    """One set for each component: for the chair Table 1 at the bottom, and the system's own values on top."""
    sets = {component: ParameterSet(component, {}) for component in sources.COMPONENTS}
    sets["Chair"] = parameter_set.from_variant(chair).over(parameter_set.reference())
    for name in chosen:
        component, more = sources.parameter_set(name)
        sets[component] = more.over(sets[component])
    for component, values in source.values.items():
        own = parameter_set.from_values(component, values, sources.RECORDS.get(component) or chair.parameters())
        sets[component] = own.over(sets[component])
    return {component: replace(s, name=BOUND) for component, s in sets.items()}


def _numbers(parameters: ParameterSet) -> ParameterSet:
    """Without choices, which libcosim cannot read: those are start values of the FMUs."""
    plain = {n: s for n, s in parameters.settings.items() if not isinstance(s.value, str)}
    return replace(parameters, settings=plain)


def _files(source: sources.Source, models: dict[str, Model], sets: dict[str, ParameterSet], version: str) -> dict[str, bytes]:
    plain = plain_system(source, models, version)
    bound = {c: _numbers(s) for c, s in sets.items()}
    outer, handles, entries = with_interface(plain, models, bound)
    known = {name: sources.parameter_set(name)[1] for name in sources.parameter_sets()}
    all_sets = {**known, **bound, handles.name: handles}
    written = {f"resources/{name}.ssv": parameter_set.text(s, version) for name, s in all_sets.items()}
    return {
        MAIN: writing.description(plain),
        INTERFACE: writing.description(outer),
        **{f"resources/{FMUS[c]}.fmu": m.archive for c, m in models.items()},
        **written,
        "resources/handles.ssm": writing.mapping(entries, version),
        "documentation/index.html": page(plain, models, sets, handles, entries),
        "documentation/licenses/license.txt": LICENCE.read_bytes(),
    }
