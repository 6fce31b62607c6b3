"""Scenes: from a file, from text, or built key by key with the checks of the reader of files."""

from __future__ import annotations

import os

from . import _kairos


def shipped_scenes() -> list[str]:
    """Names of the scenes that come with the library: `Scene.read(name)` reads one."""
    from .program import data_folder
    found = _kairos.shipped_scenes()
    if found:
        return found
    folder = data_folder("scenes")
    names = os.listdir(folder) if folder else []
    return sorted(name.rsplit(".", 1)[0] for name in names if name.endswith((".toml", ".def")))


def _find(name_or_path) -> str:
    """A shipped scene of that name, where the package was installed apart from the program."""
    from .program import data_folder
    text = os.fspath(name_or_path)
    if os.sep not in text and not os.path.splitext(text)[1] and text not in _kairos.shipped_scenes():
        folder = data_folder("scenes")
        for kind in (".toml", ".def"):
            if folder and os.path.isfile(os.path.join(folder, text + kind)):
                return os.path.join(folder, text + kind)
    return text


class Scene:
    """A scene: bodies, materials, forces; SI units, y is up. Keys are those of scene files
    (scenes/README.md), as keywords. Nothing is checked before `check`, `explain` or `kairos.run`,
    which raise `InputError` with the key: `body.ball.radius`.

        scene = Scene("drop", duration=2.0).wall("floor", shape="half-space")
        scene.ball("ball", radius=0.1, mass=1, position=(0, 5, 0))

    Every entity of the library is a method: `wall`, `ball`, `conveyor`, `bat`, ... (see `entities`),
    and so is every other list of named tables that scene files have: `many`, ...
    A `drive` may be a callable `(t, at_most) -> kairos.Motion` that holds t, or a `kairos.Spline`.
    """

    def __init__(self, name: str = "scene", **keys):
        self._draft = _kairos.SceneDraft(name)
        self.set(**keys)

    @classmethod
    def _of(cls, draft) -> "Scene":
        scene = cls.__new__(cls)
        scene._draft = draft
        return scene

    @classmethod
    def read(cls, path) -> "Scene":
        """Reads a scene file, or a shipped scene by its name. Raises `InputError`."""
        return cls._of(_kairos.SceneDraft.read(_find(path)))

    @classmethod
    def parse(cls, text: str, path: str = "") -> "Scene":
        """The same from TOML text; `path` is for messages, and where tracks are looked for."""
        return cls._of(_kairos.SceneDraft.parse(text, os.fspath(path)))

    def copy(self) -> "Scene":
        return self._of(_kairos.SceneDraft(self._draft))

    def set(self, **keys) -> "Scene":
        """Keys of the scene itself: duration (s), frame, gravity, G, bounds, summary, exact."""
        self._draft.set(keys)
        return self

    def body(self, name: str, **keys) -> "Scene":
        """A body, after those there are: order is the order of creation."""
        self._draft.body(name, keys)
        return self

    def add(self, table: str, **keys) -> "Scene":
        """An element of a list of tables of scene files: `add("many", name="gas", ...)` is `[[many]]`.
        Lists whose elements have names are methods by themselves: `many("gas", ...)`."""
        self._draft.add(table, keys)
        return self

    def force(self, kind, *, bodies=None, name=None, potential=None, rotation=False, **keys):
        """A force: a kind of scene files with its keys, or a callable.

        kind: "spring", "quadratic-drag", ... or a callable `f(t, states)` that returns newtons.
        bodies: a name: arrays are (3,), and f returns (3,); or a list of n names, which the force
            couples: (n, 3).
        potential: `u(t, states)` -> J; it then tells the whole work of the force.
        rotation: f returns (force, torque), N and N m, both of that shape.
        """
        if not callable(kind):
            self._draft.force({"kind": kind, "name": name,
                               "bodies": [bodies] if isinstance(bodies, str) else bodies, **keys})
            return self
        if bodies is None or keys:
            raise TypeError("a force of one's own takes bodies, name, potential, rotation")
        single = isinstance(bodies, str)
        self._draft.own_force(name or getattr(kind, "__name__", "force"), kind,
                              [bodies] if single else list(bodies), potential, rotation, single)
        return self

    def override(self, key: str, value) -> "Scene":
        """Replaces a value before the scene is read: `override("body.ball.radius", 0.2)`."""
        self._draft.override(key, value)
        return self

    def check(self) -> "Scene":
        """Raises `InputError` where the scene is wrong."""
        self._draft.check()
        return self

    def explain(self) -> list[tuple[str, str, str]]:
        """What the model leaves out or puts in: (topic, decision, reason)."""
        return self._draft.explain()

    def toml(self) -> str:
        """The scene as the text of a scene file."""
        return self._draft.toml()

    @property
    def name(self) -> str:
        return self._draft.name

    @property
    def bodies(self) -> list[str]:
        """Names, in the order of creation."""
        return self._draft.bodies()

    @staticmethod
    def entities() -> list[str]:
        return [row["kind"] for row in _kairos.entity_table()]

    def __repr__(self):
        return f"<kairos.Scene {self.name!r}>"


def _entity_method(row):
    keys = ", ".join(f"{key} ({unit or '1'}: {meaning})" for key, unit, meaning in row["keys"])

    def add(self, name: str, **body_keys):
        return self.body(name, entity=row["kind"], **body_keys)

    article = "An" if row["kind"][0] in "aeiou" else "A"
    add.__name__ = row["kind"].replace("-", "_")
    add.__doc__ = f"{article} {row['kind']}: {row['summary']}." + (f" Own keys: {keys}." if keys else "")
    return add


for _row in _kairos.entity_table():  # an entity that the library gains is a method by itself
    _name = _row["kind"].replace("-", "_")
    if not hasattr(Scene, _name) or _name == "body":
        if _name != "body":
            setattr(Scene, _name, _entity_method(_row))


def _list_method(table, keys):
    def add(self, name: str, **own_keys):
        return self.add(table, name=name, **own_keys)

    add.__name__ = table
    add.__doc__ = f"An element of [[{table}]] of scene files. Own keys: {', '.join(keys)}."
    return add


for _table in _kairos.scene_keys(""):
    _keys = [_key for _key in _kairos.scene_keys(_table) if _key != "name"]
    if len(_keys) < len(_kairos.scene_keys(_table)) and not hasattr(Scene, _table):
        setattr(Scene, _table, _list_method(_table, _keys))
