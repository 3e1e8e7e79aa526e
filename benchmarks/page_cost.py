"""What the model in the report's page costs: the run of `run_cost` by WebAssembly in Node, where that is installed.

The module is the lightest that a page carries: the model without effects, and with all that bring no state.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from wheelchair_fmu.campaign import read
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.engine.wasm import modules
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.report.content import STARTS

from .loop_cost import SAMPLE
from .rows import Row
from .run_cost import TOLERANCE, case

RUNS, MILLISECONDS, KILOBYTES = 25, 10.0, 100.0
SCRIPT = """
const fs = require("fs"), [file, sizes] = process.argv.slice(1), {nx, ny, n, tolerance, runs} = JSON.parse(sizes);
const {exports: wasm} = new WebAssembly.Instance(new WebAssembly.Module(fs.readFileSync(file + ".wasm")), {});
const numbers = new Float64Array(new Uint8Array(fs.readFileSync(file + ".f64")).buffer);
const base = (wasm.wc_page_heap() + 15) & ~15, count = numbers.length + n * (nx + ny) + 1;
wasm.memory.grow(Math.ceil((base + 8 * count) / 65536));
new Float64Array(wasm.memory.buffer, base, numbers.length).set(numbers);
const np = numbers.length - n - JSON.parse(sizes).nw * n, at = (i) => base + 8 * i;
const [T, W, X, Y] = [np, np + n, numbers.length, numbers.length + n * nx].map(at), took = [];
for (let i = 0; i < runs; i++) {
  const start = performance.now();
  if (wasm.wc_page_run(base, tolerance, 0, n, T, W, X, Y, at(count - 1))) throw new Error("the run failed");
  took.push(performance.now() - start);
}
const last = [...new Float64Array(wasm.memory.buffer, X + 8 * (n - 1) * nx, nx)];
console.log(JSON.stringify({took: took.slice(5), last}));
"""


def rows() -> Iterator[Row]:
    if shutil.which("node") is None or find_spec("ziglang") is None:
        return
    light = ModelFactory(read(SAMPLE), Variant()).light
    for words, variant in (("without effects", Variant()), ("with the light effects", Variant().with_effects(light))):
        (wasm,) = modules([(variant.choice, variant.active())], STARTS)
        took, off = _run(wasm, variant)
        yield Row(f"20 s run in the page, {words}", "ms", took, MILLISECONDS, note=f"states agree to {off:.0e}")
        yield Row(f"the page's model, {words}", "kB", [len(wasm) / 1e3], KILOBYTES)


def _run(wasm: bytes, variant: Variant) -> tuple[list[float], float]:
    """Milliseconds of each run, and how far the last states are off the native kernel's."""
    simulator, c = Simulator(variant), case()
    p, model = variant.vector(), simulator.model
    assert model.w.numel() == c.w.shape[1]
    native = simulator.run(c.t, c.w, p, tolerance=TOLERANCE)
    sizes = {
        "nx": native.states.shape[1],
        "ny": native.results.shape[1],
        "nw": c.w.shape[1],
        "n": len(c.t),
        "tolerance": TOLERANCE,
        "runs": RUNS,
    }
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "model"
        file.with_suffix(".wasm").write_bytes(wasm)
        file.with_suffix(".f64").write_bytes(np.concatenate([p, c.t, c.w.ravel()]).astype("<f8").tobytes())
        done = subprocess.run(["node", "-e", SCRIPT, str(file), json.dumps(sizes)], check=True, capture_output=True, text=True)
    told = json.loads(done.stdout)
    return told["took"], float(np.abs(np.array(told["last"]) - native.states[-1]).max())
