"""Build the wheelchair FMU:  python build_fmu.py [--variant better.toml] [--effects all] [--flavour python]"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from wheelchair_fmu.errors import WheelchairError
from wheelchair_fmu.fmu.build import NAMES, build
from wheelchair_fmu.model.effects import catalogue_of
from wheelchair_fmu.model.variant import Variant, read_variant


class Parser(argparse.ArgumentParser):
    def error(self, message: str):
        """One line instead of the whole usage."""
        self.exit(2, f"{message}; see {self.prog} --help\n")


def arguments(argv: list[str] | None) -> argparse.Namespace:
    parser = Parser(description="Build dist/Wheelchair.fmu, or the FMU of another variant.")
    parser.add_argument("--variant", type=Path, metavar="TOML", help="laws, effects and values, as `wheelchair add` writes")
    parser.add_argument("--effects", default="default", metavar="IDS",
                        help="default (all without states of their own), all, none, ids, or a folder of your own")  # fmt: skip
    parser.add_argument("--equations", metavar="KIND", help="extended (any motion) or paper (the paper's to the letter)")
    parser.add_argument("--flavour", default="native", help="native (C inside) or python (needs Python around it)")
    parser.add_argument("-o", "--output", type=Path, metavar="FMU", help="where to write it")
    return parser.parse_args(argv)


def main(argv: list[str] | None = None) -> int:
    given = arguments(argv)
    try:
        catalogue, effects = catalogue_of(given.effects)
        variant = read_variant(given.variant, catalogue) if given.variant else Variant(catalogue=catalogue)
        target = given.output or Path("dist") / f"{NAMES.get(given.flavour, 'Wheelchair')}.fmu"
        path = build(variant, target, effects=effects, equations=given.equations, flavour=given.flavour)
    except WheelchairError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
