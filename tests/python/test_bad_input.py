"""No argument from Python may crash the interpreter: random calls, for some seconds here, longer when run by hand.

    PYTHONPATH=BUILD/python-package LIGATURE_SOURCE=. LIGATURE_BIN=BUILD/bin python tests/python/test_bad_input.py
SECONDS [SEED]"""

import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

import ligature
from ligature import _core, inputs
from ligature.rig import Rig

SOURCE = os.path.abspath(os.environ["LIGATURE_SOURCE"])
# Exceptions by which a call may reject its arguments; any other one is an error of the package.
# Includes Refusal and TimeoutError, which derive from them.
# AssertionError: what ligature.rig waits for does not come.
ALLOWED = (ValueError, TypeError, RuntimeError, OSError, IndexError, MemoryError, AssertionError)
SPECIAL = ("__init__", "__copy__", "__deepcopy__", "__getitem__", "__len__", "__enter__", "__exit__", "__eq__", "__repr__")
DTYPES = ["f8", "f4", "f2", "i8", "u1", "?", "c16", "O", "U3", "S2", "M8[s]", ">f8"]
KEYS = ["suture.nodes", "suture.length_m", "suture.radius_m", "suture.model", "contact.friction", "contact.solver", "time.tick_s",
        "time.substeps", "world.gravity_m_per_s2", "world.fixed", "hands.coupling_N_per_m", "suture.stretch_N", "", "a.b", "\0"]


class Drawn:
    """Random values of every kind."""

    def __init__(self, seed):
        self.r = random.Random(seed)
        self.surface = Surface()

    def number(self):
        return self.r.choice([0.0, -0.0, 1.0, -1.0, 1e-320, 1e-9, 1e300, -1e300, float("inf"), float("nan"), 3, -7, 2**63, 10**400, True,
                              self.r.uniform(-3, 3), self.r.gauss(0.0, 1e3)])

    def array(self):
        shape = self.r.choice([(), (0,), (3,), (0, 3), (20, 3), (5, 3), (20, 2), (4, 5), (2, 8), (2, 20, 3), (1, 0), (1, 3)])
        try:
            array = np.array([self.number() for _ in range(int(np.prod(shape)))], dtype=object).reshape(shape)
            with np.errstate(all="ignore"):
                array = array.astype(self.r.choice(DTYPES))
        except (ValueError, TypeError, OverflowError):
            array = np.full(shape, self.r.choice([0.0, np.nan, 1e308]))
        return self.r.choice([array, array[::-1] if array.ndim else array, array.T, np.asfortranarray(array), array.tolist()])

    def any(self):
        return self.r.choice([self.number, self.array, lambda: None, lambda: "text", lambda: b"\xff", dict, object, lambda: [self.number()] * 3,
                              lambda: (0.1, 0.2, self.number()), lambda: ligature.Script(), lambda: "\ud800"])()

    def tool(self):
        tool = ligature.Tool([self.number() for _ in range(3)], [self.number() for _ in range(3)], bool(self.r.getrandbits(1)),
                             self.r.choice([None, [self.number() for _ in range(3)]]))
        return self.r.choice([None, tool, tool, self.any()])


class Surface:
    """Every function, class, method and property of the extension module and of the package, found by looking. Calls
    them on living objects, with random arguments."""

    def __init__(self):
        scene = ligature.Scene.load(SOURCE + "/scenes/paper.toml", {"suture.nodes": 20})
        sim = ligature.Simulation(scene)
        recorded = _core._read_recording(SOURCE + "/tests/fixtures/golden.lcmlog")
        self.fresh = [lambda: scene, ligature.Script, lambda: ligature.Tool((0.0, 0.0, 0.0)), sim.copy, lambda: sim._run(ligature.Script(), 0.01, 0.01, 0.0),
                      lambda: recorded, lambda: sim.knot(), lambda: sim.left, lambda: sim.diagnostics, lambda: _core._Rig(scene, []),
                      lambda: Rig(scene), lambda: Rig(scene).left]
        self.plain = [value for module in (_core, ligature, inputs) for name, value in vars(module).items()
                      if callable(value) and not name.startswith("__") and getattr(value, "__module__", "").startswith("ligature")]
        self.names = {}
        for make in self.fresh:
            thing = make()
            self.names[make] = [name for name in dir(type(thing)) if not name.startswith("__") or name in SPECIAL]
        self.called = set()

    def call(self, d):
        r, values = d.r, [d.any() for _ in range(d.r.choice([0, 0, 1, 1, 2, 3, 4, 5]))]
        if r.random() < 0.2:
            what = r.choice(self.plain)
            self.called.add(what)
            return what(*values)
        make = r.choice(self.fresh)
        name = r.choice(self.names[make])
        thing = make()
        self.called.add((type(thing).__name__, name))
        member = getattr(thing, name)
        if callable(member):
            return member(*values)
        if values:
            with contextlib.suppress(AttributeError):  # most properties cannot be set
                setattr(thing, name, values[0])
        return member

    def missed(self):
        return [each for each in [*self.plain, *((type(make()).__name__, name) for make in self.fresh for name in self.names[make])] if each not in self.called]


def one_call(d, sim):
    """One call with random arguments, with a new simulation or the given one."""
    r = d.r
    kind = r.randrange(17)
    if kind > 13:
        d.surface.call(d)
        return sim
    if kind == 0:
        text = "" if r.random() < 0.1 else "[suture]\n"
        overrides = {r.choice(KEYS): r.choice([d.number, d.array, d.any, lambda: r.randint(2, 40), lambda: "rod"])() for _ in range(r.randrange(3))}
        return ligature.Simulation(ligature.Scene.parse(text, overrides or {"suture.nodes": 20}))
    if kind == 1:
        ligature.Scene.load(d.any(), d.any())
    elif kind == 2:
        script = ligature.Script.of_keys(d.array(), d.any())
        script.tools(d.any())
        sim.run(script, 0.01)
    elif kind == 3:
        ligature.knot(d.array(), d.any())
    elif kind == 4:
        sim.set_state(d.array(), d.any())
    elif kind == 5:
        sim.set_state(sim.nodes + r.gauss(0.0, 10.0 ** r.randint(-6, 8)), sim.nodes * r.choice([0.0, 1.0, -1e3, 1e300, float("nan")]))
    elif kind == 6:
        sim.run(d.any(), d.any(), d.any(), d.any())
    elif kind == 7:
        sim.rollout([ligature.Script(), d.any()][: r.randrange(3)], d.any(), r.choice([0.01, d.number()]))
    elif kind == 8:
        for _ in range(r.randrange(30)):
            sim.tick(d.tool(), d.tool())
    elif kind == 9:
        views = sim.nodes, sim.velocities, sim.tension_N, sim.turn_rad, sim.curvature_per_m, sim.left, sim.right, sim.diagnostics, sim.scene
        return sim.copy() if all(view is not None for view in views) else sim
    elif kind == 10:
        sim.reset()
        sim.knot()
    elif kind == 11:
        ligature.Simulation(d.any())
    elif kind == 12:
        ligature.Recording(d.any())
    else:
        image = bytearray(sim.save())
        del image[r.choice([len(image), r.randrange(len(image))]) :]
        if image:
            image[r.randrange(len(image))] ^= 1 << r.randrange(8)
        sim.load(bytes(image))
        raise SystemError("a damaged image was loaded")
    return sim


def too_long(*_):
    raise TimeoutError


def call_for_a_while(d, sim):
    """One call, interrupted as by Ctrl-C when it is long. The alarm may still come in `finally`: it leaves by here too."""
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        return one_call(d, sim)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def draw_for(seconds, seed):
    signal.signal(signal.SIGALRM, too_long)
    d, calls, refused = Drawn(seed), 0, 0
    fresh = ligature.Simulation(ligature.Scene.load(SOURCE + "/scenes/paper.toml", {"suture.nodes": 20}))
    sim, end = fresh, time.monotonic() + seconds
    while time.monotonic() < end:
        calls += 1
        try:
            sim = call_for_a_while(d, sim)
        except ALLOWED:
            refused += 1
        if sim.scene.nodes > 200 or calls % 100 == 0:
            sim = fresh.copy()
    print(f"seed {seed}: {calls} calls, {refused} refused, {len(d.surface.missed())} members of the surface not called")
    return calls


def test_random_calls():
    """In a child process, so that a crash is a failed test and does not end the others."""
    from seeds import shifted  # its folder is known to pytest only (conftest.py)

    done = subprocess.run([sys.executable, __file__, "8", str(shifted(0))], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, (done.returncode, done.stdout[-500:], done.stderr[-2000:])
    assert int(done.stdout.split()[2]) > 100


if __name__ == "__main__":
    sys.path[:] = map(os.path.abspath, sys.path)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # calls of save() leave files
        draw_for(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
