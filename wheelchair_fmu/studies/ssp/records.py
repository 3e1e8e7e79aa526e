"""What is in an .ssp: one record for each element of the standard that is used here."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...fmu.parameter_set import SspUnit

MAIN = "SystemStructure.ssd"


@dataclass(frozen=True)
class Scaling:
    """What is done to a value on its way: `target = factor · source + offset`."""

    factor: float = 1.0
    offset: float = 0.0
    suppress_units: bool = False  # units are not converted


@dataclass(frozen=True)
class Connector:
    """A variable that an element shows; of `kind` input, output, parameter, …"""

    name: str
    kind: str
    type: str = "Real"
    unit: str = ""
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class MappingEntry:
    """A name in a parameter set, and the parameter that takes its value."""

    source: str
    target: str
    scaling: Scaling = Scaling()
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class Binding:
    """A parameter set for an element: a file, or elements inside; the names may be mapped to others."""

    source: str = ""
    prefix: str = ""
    mapping: str = ""
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class Component:
    """An FMU in the system. `place` is (x1, y1, x2, y2) in the diagram."""

    name: str
    source: str
    connectors: tuple[Connector, ...] = ()
    bindings: tuple[Binding, ...] = ()
    place: tuple[float, float, float, float] | None = None
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class Connection:
    """From an element's connector to another's; an element called "" is the system itself."""

    start_element: str
    start_connector: str
    end_element: str
    end_connector: str
    scaling: Scaling = Scaling()
    line: int = field(default=0, compare=False)

    def __str__(self) -> str:
        start, end = (
            f"{e}.{c}" if e else c
            for e, c in ((self.start_element, self.start_connector), (self.end_element, self.end_connector))
        )
        return f"connection {start} → {end}"


@dataclass(frozen=True)
class System:
    """One .ssd: elements, what connects them, and how it is run. Times in s."""

    name: str
    components: tuple[Component, ...]
    connections: tuple[Connection, ...]
    connectors: tuple[Connector, ...] = ()
    bindings: tuple[Binding, ...] = ()
    units: tuple[SspUnit, ...] = ()
    start: float = 0.0
    stop: float | None = None
    step: float | None = None
    description: str = ""
    version: str = "1.0"
    line: int = field(default=0, compare=False)

    def component(self, name: str) -> Component | None:
        return next((c for c in self.components if c.name == name), None)
