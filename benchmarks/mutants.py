"""Do the tests notice? Faults are put into a scratch copy of the package, one at a time, and the tests that concern each run.

    python -m benchmarks.mutants                        the named faults, each of which has once gone unnoticed
    python -m benchmarks.mutants --sample 30 --seed 2   and as many more, drawn from operators, signs, constants, comparisons
    python -m benchmarks.mutants --drawn --sample 30    these alone; it fails where fewer than nine in ten are noticed
    python -m benchmarks.mutants --sample 9 --only wheelchair_fmu/model/chassis.py --tests tests/model

A runner of our own, because mutmut 3 puts all mutants of a file into one text and chooses by an environment variable:
kernels, which are kept by the model's text, would then be those of whichever mutant came first. cosmic-ray has one command for
all mutants, and here the tests of a folder take ten minutes; each mutant meets the test files that name its module.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("inference", "model", "campaign")  # of the package, whose files are changed
OF_C = {"wheelchair_fmu/engine/csrc/evaluation.c": ("tests/inference/test_statistics.py",)}  # which tests concern it
TESTS = {"inference": ("inference",), "model": ("model", "independent", "contracts"), "campaign": ("campaign",)}
LEAST = 0.9  # of those that are drawn, which have to be noticed: some change nothing that anybody could see
PATIENCE = 3.0  # times as long as the tests take without a fault, and
SLACK = 60.0  # s, for a kernel to be compiled
SWAPS = {
    **{ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")},
    **{ast.Lt: ("<", ">="), ast.LtE: ("<=", ">"), ast.Gt: (">", "<="), ast.GtE: (">=", "<")},
    **{ast.Eq: ("==", "!="), ast.NotEq: ("!=", "=="), ast.And: ("and", "or"), ast.Or: ("or", "and")},
}
L, M = "wheelchair_fmu/inference/", "wheelchair_fmu/model/"
NAMED = (  # file, what stands there once, what stands there instead
    (M + "wheel/rolling.py", "F_max * cs.vertcat(brake_rl, brake_rr)", "F_max * cs.vertcat(brake_rr, brake_rl)"),
    (M + "chassis.py", "needed * R / R_rim", "needed * R_rim / R"),
    (M + "caster/swivelling.py", "- c * psi_dot", "+ c * psi_dot"),
    (M + "caster/swivelling.py", "aside = v_yf * (1 - rests)", "aside = 0.0 * v_yf * (1 - rests)"),
    (M + "effects/relaxation_length.py", "slip = -v_yw / magnitude", "slip = v_yw / magnitude"),
    (M + "smooth.py", "(1 + bend) / 3) * z2", "(1 - bend) / 3) * z2"),
    (M + "caster/ideal.py", "lateral * v_xf, -M_w", "lateral * v_xf, M_w"),
    (M + "caster/swivelling.py", "lateral * forward, -(c / lever) * M_w", "lateral * forward, c / lever * M_w"),
    (M + "chassis.py", "F_rl + M_rl / R, F_rr + M_rr / R", "F_rr + M_rr / R, F_rl + M_rl / R"),
    (M + "chassis.py", "cs.vertcat(-t_r / 2, t_r / 2)", "cs.vertcat(t_r / 2, -t_r / 2)"),
    (L + "search/judge.py", "p=min(1.0, tests * p)", "p=min(1.0, p)"),
    (L + "search/judge.py", "fall / dispersion, corr", "fall, corr"),
    (L + "search/judge.py", "fit.deviance - _paid(fit, names, at_usual.moved(fit.covariance))", "fit.deviance"),
    (L + "search/judge.py", "at_usual.own, at_usual.size, at_usual.moved(told)", "at_usual.own, at_usual.size, told"),
    (L + "estimation/led.py", "return half - pulls, max(0.0, bent)", "return half, max(0.0, bent)"),
    (L + "estimation/led.py", "likelihood.beside(found.led_from(here), HELD).evidence(runs, values)", "found"),
    (L + "estimation/statistics.py", "np.linalg.pinv(R.T) @ e.beyond", "0.0"),
    (L + "estimation/left_out.py", "axes.T @ (e.pull / scale)", "axes.T @ (S.T @ e.r[e.finite] / scale)"),
    (L + "search/screen.py", "if not max(told.likelihood_ratio, 0.0) < fall < math.inf:", "if fall:"),
    (L + "search/usual.py", "longer * np.outer(size[of_it], by_constant)", "0.0"),
    (L + "search/usual.py", "(adjusted / usually, by_constant)", "(usually / adjusted, by_constant)"),
    (L + "search/judge.py", "p /= 2", "p /= 1"),
    (L + "search/judge.py", "chance_beyond(ratio / correlation, len", "chance_beyond(ratio, len"),
    (L + "estimation/score.py", "p / 2 if estimate[0] > 0 else 1 - p / 2", "p"),
    (L + "estimation/score.py", "width = min(lags, len(q) // 4) + 1", "width = 1"),
    (L + "estimation/statistics.py", "1 + 2 * _lasting(r)", "1 + _lasting(r)"),
    (L + "estimation/statistics.py", " / np.sqrt(np.maximum(size, ALONE))", ""),
    (L + "estimation/statistics.py", "student(0.95, n - 1)", "student(0.5, n - 1)"),
    (L + "estimation/statistics.py", " * float(np.mean(evidence.r**2))", ""),
    (
        L + "estimation/statistics.py",
        "robust_variance(found.evidence, S, r) + found.prior_slopes**2",
        "S.T @ S + found.prior_slopes**2",
    ),
    (L + "decision/bootstrap.py", "(0.025, 0.975)", "(0.25, 0.75)"),
    (L + "estimation/interval.py", "student(LEVEL, degrees_between_runs(found, at))", "NORMAL"),
    (L + "evidence/likelihood.py", "YAW_INERTIA: bends", "YAW_INERTIA: 0 * bends"),
    (L + "evidence/disturbance.py", "uneven.tremor / (t_r / 2)", "uneven.tremor / t_r"),
    (L + "evidence/likelihood.py", "np.clip(s, -3 * sd[n], 3 * sd[n])", "np.clip(s, -30 * sd[n], 30 * sd[n])"),
    (L + "evidence/noise_model.py", "-1 / inertia[process]", "0 / inertia[process]"),
    (L + "evidence/noise_model.py", "*range(SWINGS.start, FORCED))", "*range(SWINGS.start, SWINGS.stop))"),
    (L + "evidence/noise_model.py", "noise_model.floor * noise_model.lever)", "noise_model.floor)"),
    (L + "evidence/noise_model.py", "return self.sd.get(MOMENTUM, 0.0)", "return 0.0"),
    ("wheelchair_fmu/campaign/swinging.py", "DEGREE, STIFF = 5, 4", "DEGREE, STIFF = 5, 2"),
    ("wheelchair_fmu/engine/csrc/evaluation.c", "#define REACH 3.0", "#define REACH 30.0"),
    ("wheelchair_fmu/engine/csrc/evaluation.c", "feel(s, e, e->driven);", ""),
    ("wheelchair_fmu/engine/csrc/evaluation.c", "    feel(s, e, to);\n}", "}"),
)


@dataclass(frozen=True)
class Mutant:
    """Bytes `begin`…`end` of a file become `after`."""

    path: str
    begin: int
    end: int
    before: str
    after: str

    def text(self, source: bytes) -> bytes:
        return source[: self.begin] + self.after.encode() + source[self.end :]

    def __str__(self) -> str:
        source = (ROOT / self.path).read_bytes()
        number = source.count(b"\n", 0, self.begin) + 1
        was, now = (text.splitlines()[number - 1].strip() for text in (source.decode(), self.text(source).decode()))
        return f"{self.path}:{number}\n    - {was}\n    + {now}"


def named() -> Iterator[Mutant]:
    for path, before, after in NAMED:
        source = (ROOT / path).read_bytes()
        if source.count(before.encode()) != 1:
            raise SystemExit(f"{path} has {before!r} {source.count(before.encode())} times: bring NAMED up to date")
        begin = source.index(before.encode())
        yield Mutant(path, begin, begin + len(before.encode()), before, after)


def possible(path: str) -> Iterator[Mutant]:
    """Every operator, sign, number and comparison of a file as something else."""
    source = (ROOT / path).read_bytes()
    lines = [0, *(i + 1 for i, byte in enumerate(source) if byte == 10)]

    def span(node: ast.expr) -> tuple[int, int]:
        return lines[node.lineno - 1] + node.col_offset, lines[node.end_lineno - 1] + node.end_col_offset

    def between(left: ast.expr, right: ast.expr, kind: type) -> Iterator[Mutant]:
        if kind in SWAPS:
            begin, (before, after) = span(left)[1], SWAPS[kind]
            at = source.find(before.encode(), begin, span(right)[0])
            if at >= 0:
                yield Mutant(path, at, at + len(before), before, after)

    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.BinOp):
            yield from between(node.left, node.right, type(node.op))
        elif isinstance(node, ast.BoolOp):
            yield from between(*node.values[:2], type(node.op))
        elif isinstance(node, ast.Compare):
            yield from between(node.left, node.comparators[0], type(node.ops[0]))
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
            begin, end = span(node)[0], span(node.operand)[0]
            yield Mutant(path, begin, end, source[begin:end].decode(), "")
        elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
            begin, end = span(node)
            yield Mutant(path, begin, end, source[begin:end].decode(), repr(node.value * 2 if node.value else 1))


def sampled(count: int, seed: int, only: str) -> list[Mutant]:
    files = (p.relative_to(ROOT).as_posix() for f in FOLDERS for p in sorted((ROOT / "wheelchair_fmu" / f).rglob("*.py")))
    everything = [m for path in files if path.startswith(only) for m in possible(path)]
    return random.Random(seed).sample(everything, min(count, len(everything)))


@cache
def concerned(path: str) -> tuple[str, ...]:
    """The test files of a module's folder that name it, or all where none does."""
    if path in OF_C:
        return OF_C[path]
    of, stem = path.split("/")[1], Path(path).stem
    files = [f for folder in TESTS[of] for f in sorted((ROOT / "tests" / folder).rglob("test_*.py"))]
    naming = [f for f in files if stem in f.read_text(encoding="utf-8")] or files
    return tuple(f.relative_to(ROOT).as_posix() for f in naming)


class Scratch:
    """A copy of the project in which tests run, each time in a session of their own that is ended as a whole."""

    def __init__(self, folder: Path):
        self.folder = folder
        for name in subprocess.check_output(["git", "ls-files", "-z"], cwd=ROOT, text=True).split("\0")[:-1]:
            if (ROOT / name).is_file():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(ROOT / name, folder / name)
        self.took: dict[str, float] = {}

    def run(self, tests: tuple[str, ...], limit: float | None = None) -> int | None:
        """What pytest returns, None where it took too long."""
        words = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *tests]
        settings = {"PYTHONDONTWRITEBYTECODE": "1", "WHEELCHAIR_CACHE": str(self.folder / "cache")}
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        child = subprocess.Popen(words, cwd=self.folder, env=os.environ | settings, start_new_session=True, **quiet)
        try:
            return child.wait(limit)
        except subprocess.TimeoutExpired:
            return None
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()

    def ready(self, tests: tuple[str, ...]) -> tuple[str, ...]:
        """These tests, the quickest first, once each has been seen to pass without a fault."""
        for test in (t for t in tests if t not in self.took):
            begun = time.monotonic()
            if self.run((test,)) not in (0, 5):  # 5: none of its tests are for every day
                raise SystemExit(f"{test} fails without any fault")
            self.took[test] = time.monotonic() - begun
        return tuple(sorted(tests, key=self.took.__getitem__))

    def fate(self, mutant: Mutant, tests: tuple[str, ...]) -> str:
        tests, source = self.ready(tests), (ROOT / mutant.path).read_bytes()
        (self.folder / mutant.path).write_bytes(mutant.text(source))
        try:
            code = self.run(tests, SLACK + PATIENCE * sum(self.took[t] for t in tests))
        finally:
            (self.folder / mutant.path).write_bytes(source)
        return "too slow" if code is None else "survived" if code == 0 else "killed"


def enough(noticed: int, drawn: int) -> bool:
    """Are as many noticed of those that are drawn as have to be?"""
    return noticed >= LEAST * drawn


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", type=int, default=0, help="so many mutants drawn at random, besides those that are named")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--drawn", action="store_true", help="only those that are drawn, of which a few may go unnoticed")
    parser.add_argument(
        "--only", default="", metavar="PATH", help="mutants of this file or folder, wheelchair_fmu/inference for one"
    )
    parser.add_argument("--tests", nargs="+", default=(), help="run these test files, not all that name a mutant's module")
    given = parser.parse_args()
    if given.drawn and not given.sample:
        parser.error("--drawn without --sample draws nothing; say how many, as in --sample 30")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended"))  # and with it the tests that run, and the copy
    by_name = [] if given.drawn else [m for m in named() if m.path.startswith(given.only)]
    mutants = [*by_name, *sampled(given.sample, given.seed, given.only)]
    fates = []
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        scratch = Scratch(Path(folder))
        for mutant in mutants:
            fates.append(scratch.fate(mutant, tuple(given.tests) or concerned(mutant.path)))
            print(f"{fates[-1]:8} {mutant}", flush=True)
    survivors = [m for m, fate in zip(mutants, fates, strict=True) if fate == "survived"]
    print(f"\n{len(mutants) - len(survivors)} of {len(mutants)} noticed, {fates.count('too slow')} of these by their time")
    if survivors:
        print("not noticed:", *survivors, sep="\n")
    sys.exit(not enough(len(mutants) - len(survivors), len(mutants)) if given.drawn else bool(survivors))


if __name__ == "__main__":
    main()
