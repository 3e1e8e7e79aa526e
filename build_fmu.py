"""Build the wheelchair FMU:  python build_fmu.py [--variant better.toml] [--effects all] [--platforms all]"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from wheelchair_fmu.cli.terminal import printable
from wheelchair_fmu.errors import WheelchairError


class Parser(argparse.ArgumentParser):
    def error(self, message: str):
        """One line instead of the whole usage."""
        self.exit(2, f"{message}; see {self.prog} --help\n")


def arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = Parser(description="Build dist/Wheelchair.fmu (FMI 2.0) and dist/Wheelchair.fmi3.fmu, or another variant's.")
    parser.add_argument("--variant", type=Path, metavar="TOML", help="laws, effects and values, as `wheelchair add` writes")
    parser.add_argument(
        "--effects",
        default="default",
        metavar="IDS",
        help="default (all without states of their own), all, none, ids, or a folder of your own",
    )
    parser.add_argument("--equations", metavar="KIND", help="extended (any motion) or paper (the paper's to the letter)")
    parser.add_argument("--flavour", default="native", help="native (C inside) or python (needs Python around it)")
    parser.add_argument("--fmi", metavar="VERSION", help="2, 3 or both (the default; pythonfmu makes 2 only)")
    parser.add_argument(
        "--platforms",
        default="host",
        metavar="NAMES",
        help="host, all (Linux and macOS on x86-64 and ARM, Windows), or names with commas",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FMU", help="where to write it; FMI 3.0 beside it, as .fmi3.fmu")
    return parser.parse_args(argv)


def targets(version: str | None, flavour: str, first: Path) -> dict[str, Path]:
    """Where to write which version of FMI."""
    version = version or ("2" if flavour == "python" else "both")
    if version == "both":
        return {"2": first, "3": first.with_name(f"{first.stem}.fmi3.fmu")}
    return {version: first}


def main(argv: list[str] | None = None) -> int:
    given = arguments(argv)
    try:
        print(*built(given), sep="\n")
    except (WheelchairError, OSError, MemoryError, RecursionError, KeyboardInterrupt) as error:
        from wheelchair_fmu.cli.group import ending

        message, code = ending(error)
        print(printable(message), file=sys.stderr)
        return code
    return 0


def built(given: argparse.Namespace) -> list[Path]:
    # imported here, for it takes seconds, and Ctrl-C then is no fault either
    from wheelchair_fmu.contracts.own import catalogue_of
    from wheelchair_fmu.fmu.build import NAMES, build_each
    from wheelchair_fmu.model.variant import Variant, read_variant

    catalogue, effects = catalogue_of(given.effects)
    variant = read_variant(given.variant, catalogue) if given.variant else Variant(catalogue=catalogue)
    first = given.output or Path("dist") / f"{NAMES.get(given.flavour, 'Wheelchair')}.fmu"
    return build_each(
        targets(given.fmi, given.flavour, first),
        variant,
        effects=effects,
        equations=given.equations,
        flavour=given.flavour,
        platforms=given.platforms,
    )


if __name__ == "__main__":
    sys.exit(main())
