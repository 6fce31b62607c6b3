"""Names, colours and marks of methods: the one place that owns them.

A scheme and a detector have a colour, a dash and a mark. An integrator's colour is its order, its
mark tells it from others of that order. A name of two choices ("original, rk4") takes colour and dash
of the first that is a scheme or a detector, and the mark of the other. What else a name tells (a
threshold, a step) does not change a look.
"""

import re

# Paul Tol's "bright" colours, ordered so that neighbours differ in lightness, too.
COLOURS = ["#222255", "#EE6677", "#228833", "#AA3377", "#4477AA", "#CC9900", "#66CCEE", "#888888"]
# Two more, for there are ten schemes.
SCHEME_COLOURS = COLOURS + ["#8B5A2B", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*", "<", ">", "h", "p"]
DASHES = ["-", "--", "-.", (0, (1, 1.2)), (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (3, 1, 1, 1)),
          (0, (2, 2))]

# In the order of the thesis' own method and its cures; then those that people use.
SCHEMES = ["original", "geometric", "substepped", "equal substeps", "bisected", "event-driven",
           "moreau-jean", "pgs", "xpbd", "penalty"]
_SCHEME = {name: (SCHEME_COLOURS[i], MARKERS[i], DASHES[i % 8]) for i, name in enumerate(SCHEMES)}

# The thesis' own method as a whole: `original` with its own integrator and impact law, filled.
THESIS = "thesis"

DETECTORS = ["certified", "conservative-advancement", "bisection", "linear", "cvode-rootfinding",
             "sat", "FCL", "Bullet"]

# By order: "exact" and those that choose their order come last.
INTEGRATORS = {
    "1": ["thesis-euler", "explicit-euler", "symplectic-euler"],
    "2": ["velocity-verlet", "free-top-splitting", "arkode-2"],
    "3": ["arkode-3"],
    "4": ["rk4", "forest-ruth", "suzuki4", "rkmk4", "arkode-4"],
    "5": ["dopri5", "gsl-rkf45", "gsl-rkck", "arkode-5"],
    "6, 8": ["arkode-6", "gsl-rk8pd", "arkode-8"],
    "chooses": ["cvode-adams", "cvode-bdf", "gsl-msadams", "gsl-bsimp"],
    "exact": ["closed-form", "auto"],
}
_ORDER_COLOUR = dict(zip(INTEGRATORS, ["#EE6677", "#CC9900", "#66CCEE", "#228833", "#4477AA",
                                       "#AA3377", "#888888", "#222255"]))
# No two integrators have both colour and mark in common; those that figures compare beside a scheme
# differ in the mark alone.
_MARK = {"thesis-euler": "o", "explicit-euler": "<", "symplectic-euler": "s",
         "velocity-verlet": "^", "free-top-splitting": "h", "arkode-2": "d", "arkode-3": "d",
         "rk4": "D", "forest-ruth": "v", "suzuki4": ">", "rkmk4": "p", "arkode-4": "d",
         "dopri5": "P", "gsl-rkf45": "X", "gsl-rkck": "H", "arkode-5": "d", "arkode-6": "d",
         "gsl-rk8pd": "8", "arkode-8": "D", "cvode-adams": "v", "cvode-bdf": "^",
         "gsl-msadams": "s", "gsl-bsimp": "o", "closed-form": "*", "auto": "*"}
_ORDER_OF = {name: order for order, names in INTEGRATORS.items() for name in names}
_DETECTOR = {name: (COLOURS[(5 - i) % 8], MARKERS[i], DASHES[i]) for i, name in enumerate(DETECTORS)}


def _named(name, known):
    """The first word of a name that is in `known`; None: none is."""
    return next((word for word in re.split("[ ,]+", str(name)) if word in known), None)


def scheme_of(name):
    """The scheme that a name begins with; None: none."""
    for scheme in SCHEMES:
        if re.match(f"{scheme}($|[ ,])", str(name)):
            return scheme
    return "original" if name == THESIS else None


def by_place(i, label):
    """Of what is no method, or of one method several times: the i-th look."""
    return {"color": COLOURS[i % 8], "marker": MARKERS[i % len(MARKERS)],
            "linestyle": DASHES[i % 8], "markeredgewidth": 1.1, "markerfacecolor": "white",
            "label": label}


def look(name, names=()):
    """Line properties of a method. A name that is no method of ours (of a user's own sweep) takes
    what is left, by its place among `names`."""
    scheme, integrator = scheme_of(name), _named(name, _MARK)
    detector = _named(name, _DETECTOR)
    if scheme is not None:
        colour, mark, dash = _SCHEME[scheme]
        if detector and not integrator:
            mark = _DETECTOR[detector][1]
    elif detector is not None:
        colour, mark, dash = _DETECTOR[detector]
    elif integrator is not None:
        order = _ORDER_OF[integrator]
        colour = _ORDER_COLOUR[order]
        dash = DASHES[INTEGRATORS[order].index(integrator) % len(DASHES)]
    else:
        others = [other for other in names if other not in _SCHEME and other not in _MARK]
        i = others.index(name) if name in others else 0
        return by_place(i, name)
    mark = _MARK[integrator] if integrator else mark
    return {"color": colour, "marker": mark, "linestyle": dash, "markeredgewidth": 1.1,
            "markerfacecolor": colour if name == THESIS else "white", "label": name}
