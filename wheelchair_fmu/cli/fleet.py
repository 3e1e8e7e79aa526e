"""`wheelchair fleet`: many campaigns diagnosed side by side, and what they have in common."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import pandas as pd
import pyarrow.parquet as pq
import typer
from rich import box
from rich.table import Table

from ..chunks import bad, is_done
from ..errors import UsageError
from ..fleet import Fleet, folders, long, summary
from ..inference.subject import chair
from ..model.former import current
from ..model.recipe import Recipe
from ..writing import written
from .chunked import Address, Workers, done_with_a_bar, pool_of
from .group import console
from .settings import parse
from .terminal import announce
from .trust import variant_option

ENDINGS = (".parquet", ".csv")
LEAST = 1e-6  # probability that is told by its size


def register(app: typer.Typer) -> None:
    app.command()(fleet)


def fleet(
    campaigns: Annotated[list[Path], typer.Argument(metavar="FOLDER...", help="Campaigns, or folders of campaigns.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="OUT", help="The table: .parquet, or .csv beside it.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    workers: Workers = None,
    address: Address = None,
) -> None:
    """Diagnose every campaign of a fleet. Killed and run again, it goes on where it stood."""
    if output.suffix not in ENDINGS:
        raise UsageError(f"-o {output}: give a name that ends in {' or '.join(ENDINGS)}")
    pool = pool_of(address, workers)
    recipe = Recipe.of(chair(variant, effects))
    given = current(parse(settings or ()), dict(recipe.values))
    job = Fleet(folders(campaigns), tuple(given.items()), recipe)
    job.chair()  # a wrong question is told before anything is done
    whole = output.with_suffix(".parquet")
    if is_done(job, whole):
        console(stderr=True).print(f"{whole}: already done for these campaigns")
    done_with_a_bar(job, whole, pool, "campaigns", job.known(whole))
    _tell(whole, output)


def _tell(whole: Path, output: Path) -> None:
    table = pq.read_table(whole)
    found, (failed, first) = long(table), bad(whole)
    chairs = table.num_rows - failed
    together = summary(found, chairs) if chairs else pd.DataFrame()
    announce(whole)
    if output != whole:
        _write(output, table.to_pandas())
    _write(output.with_name(f"{output.stem}-effects.csv"), found)
    _write(output.with_name(f"{output.stem}-summary.csv"), together)
    if failed:
        console(stderr=True).print(
            f"{failed} of {table.num_rows} campaigns were not diagnosed (see column error), the first: {first}"
        )
    if chairs:
        console().print(_verdicts(table.to_pandas()))
    if len(together):
        console().print(_shares(together, chairs))
        console().print(_sizes(together))


def _write(file: Path, table: pd.DataFrame) -> None:
    with written(file) as beside:
        table.to_csv(beside, index=False, float_format="%.6g", lineterminator="\n")
    announce(file)


def _verdicts(table: pd.DataFrame) -> Table:
    """How often each verdict was given, and what it left on runs held out."""
    shown = Table(
        box=box.SIMPLE, title="whitened RMS error on runs held out, median; 1.0 is the noise floor", title_justify="left"
    )
    for title in ("verdict", "chairs", "calibrated", "with what was found"):
        shown.add_column(title, justify="left" if title == "verdict" else "right")
    for verdict, rows in table.groupby("verdict"):
        medians = rows[["rms_holdout_calibrated", "rms_holdout"]].median()
        shown.add_row(str(verdict), str(len(rows)), *(f"{m:.3f}" if pd.notna(m) else "" for m in medians))
    return shown


def _chance(p: float) -> str:
    """A probability that chance does as much; so far out in the tails nobody knows it to a digit."""
    return f"{p:.2g}" if p >= LEAST else f"< {LEAST:g}"


def _shares(together: pd.DataFrame, chairs: int) -> Table:
    """How many chairs lack each effect."""
    shown = Table(box=box.SIMPLE, title=f"what {chairs} chairs lack", title_justify="left")
    for title in ("effect", "missing", "tied", "small", "missing or tied", "95 %"):
        shown.add_column(title, justify="left" if title == "effect" else "right")
    for row in together.drop_duplicates("effect").itertuples():
        counts = map(str, (row.missing, row.tied, row.small))
        shown.add_row(row.effect, *counts, f"{row.share:.0%}", f"{row.low:.0%} to {row.high:.0%}")
    return shown


def _sizes(together: pd.DataFrame) -> Table:
    """How large what is lacking is, and whether as large in all chairs."""
    shown = Table(
        box=box.SIMPLE,
        title="its size where it is missing or tied, and whether that is the same in all chairs",
        title_justify="left",
    )
    for title in ("parameter", "chairs", "mean", "chair to chair", "Q", "p", "I²"):
        shown.add_column(title, justify="left" if title == "parameter" else "right")
    for row in together[together.n > 0].itertuples():
        sameness = (f"{row.spread:.2g}", f"{row.Q:.3g}", _chance(row.p), f"{row.I2:.0%}") if row.n > 1 else ("",) * 4
        shown.add_row(f"{row.effect}.{row.parameter}", str(row.n), f"{row.mean:.3g} ± {row.se:.2g} {row.unit}", *sameness)
    return shown
