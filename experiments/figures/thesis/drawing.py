"""What the drawings of several figures share."""

from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch, Polygon, Rectangle

FIRST = "#dfe6f2"   # a light blue, a light red, a light green: told apart by their place, too
SECOND = "#f6d9de"
THIRD = "#e0eddf"


def wall(panel, left, right, depth):
    """The half-space below y = 0."""
    panel.add_patch(Rectangle((left, -depth), right - left, depth, facecolor="#e6e6e6",
                              edgecolor="#bbbbbb", hatch="///", linewidth=0, zorder=0))
    panel.plot([left, right], [0, 0], color="black", linewidth=1.2, zorder=1)


def ball(panel, x, y, radius, fill=FIRST, line="-", zorder=2):
    panel.add_patch(Circle((x, y), radius, facecolor=fill, edgecolor="black", linestyle=line,
                           linewidth=1.3, alpha=0.85, zorder=zorder))
    panel.plot([x], [y], "k.", markersize=4, zorder=zorder + 2)


def outline(panel, corners, fill="none", line="-", zorder=2, **more):
    panel.add_patch(Polygon(corners, closed=True, facecolor=fill, edgecolor="black",
                            linestyle=line, linewidth=1.3, zorder=zorder, **more))


def rectangle(panel, x, y, dx, dy, fill=FIRST, line="-", zorder=2):
    outline(panel, [(x, y), (x + dx, y), (x + dx, y + dy), (x, y + dy)], fill, line, zorder,
            alpha=0.85)


def node(panel, x, y, text, width, height, fill="white", size=9.5, weight="normal"):
    """A box of a diagram, centred at (x, y)."""
    panel.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height,
                                   boxstyle="round,pad=0,rounding_size=0.08", facecolor=fill,
                                   edgecolor="black", linewidth=1.1, zorder=3))
    panel.text(x, y, text, ha="center", va="center", fontsize=size, fontweight=weight, zorder=4)


def arrow(panel, start, end, bend=0.0, line="-", width=1.1):
    panel.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=11,
                                    connectionstyle=f"arc3,rad={bend}", linewidth=width,
                                    linestyle=line, color="black", zorder=2, shrinkA=0,
                                    shrinkB=0))


def bare(panel, left, right, bottom, top):
    """No axes: a diagram has no units."""
    panel.set_xlim(left, right)
    panel.set_ylim(bottom, top)
    panel.set_aspect("equal")
    panel.axis("off")
