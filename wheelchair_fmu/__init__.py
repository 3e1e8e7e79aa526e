"""A manual wheelchair on real tyres, as an FMU, and a loop that finds what its model misses."""

__version__ = "0.1.0"

# Public names, and the module that each comes from when it is first asked for: together they take seconds to load, and a
# command may need none. Type checkers read the same in __init__.pyi.
_FROM = {
    "Campaign": "api.campaigns",
    "CampaignError": "errors",
    "Comparison": "api.comparisons",
    "Diagnosis": "api.diagnoses",
    "Failure": "errors",
    "Tyre": "api.tyres",
    "UsageError": "errors",
    "Variant": "api.variants",
    "WheelchairError": "errors",
    "build": "api.building",
    "diagnose": "api.diagnoses",
    "linearize": "api.linear",
    "read": "api.campaigns",
    "sample": "api.samples",
    "save": "api.frames",
    "simulate": "api.runs",
}

__all__ = ["__version__", *_FROM]


def __getattr__(name: str) -> object:
    if name not in _FROM:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    found = getattr(import_module(f".{_FROM[name]}", __name__), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
