"""The plots of the accuracy study as SVG to stand within a page: their text and axes have the colour of the page's text."""

import io
import re

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402  (the backend is chosen before)
from matplotlib.ticker import FuncFormatter, NullFormatter  # noqa: E402

from accuracy_data import DEFAULT, FORMS, front  # noqa: E402

COLOURS = {("gauss_seidel", "tensor"): "#3b82f6", ("gauss_seidel", "scalar"): "#f08030", ("jacobi", "tensor"): "#22a06b",
           ("jacobi", "scalar"): "#c65fb4"}
TEXT = "#010203"  # replaced by the page's own
REALTIME = "#d94848"


def start(width=8.2, height=4.2):
    pyplot.rcParams.update({"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 10, "text.color": TEXT, "axes.labelcolor": TEXT,
                            "axes.edgecolor": TEXT, "xtick.color": TEXT, "ytick.color": TEXT, "svg.hashsalt": "loam"})
    figure, axes = pyplot.subplots(figsize=(width, height))
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.grid(color="#888888", alpha=0.25, linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def finish(figure, number=[0]):
    figure.tight_layout()
    number[0] += 1
    text = io.StringIO()
    pyplot.rcParams["svg.hashsalt"] = f"loam {number[0]}"  # ids of one page must differ
    figure.savefig(text, format="svg", transparent=True, metadata={"Date": None})
    pyplot.close(figure)
    svg = text.getvalue()
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg[svg.index("<svg"):], flags=re.DOTALL)
    return svg.replace(TEXT, "currentColor")


def percent(value, _):
    return f"{100 * value:.6g} %"


def plain(value, _):
    return f"{value:.6g}"


def logarithmic(axes, x_label, y_label, x_percent=False, y_percent=True):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(FuncFormatter(percent if x_percent else plain))
    axes.yaxis.set_major_formatter(FuncFormatter(percent if y_percent else plain))
    low, high = axes.get_ylim()
    axes.yaxis.set_minor_formatter(FuncFormatter(percent) if high < 20 * low else NullFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)


def error_over_time(rows, y_label, presets=(), others=(), most=3):
    """A dot a setting; a line through the cheapest of each form; what is beyond `most` is drawn there."""
    figure, axes = start()
    for form, name in FORMS.items():
        own = [row for row in rows if row.form == form]
        if not own:
            continue
        axes.plot([row.frame for row in own], [min(row.seen, most) for row in own], "o", color=COLOURS[form], markersize=4, alpha=0.45, markeredgewidth=0)
        line = [row for row in front(own) if row.off < most]
        axes.plot([row.frame for row in line], [row.off for row in line], "-o", color=COLOURS[form], label=name, markersize=5, linewidth=1.6)
        if form == DEFAULT:
            for row in line[::max(1, len(line) // 5)]:
                axes.annotate(row.setting, (row.frame, row.off), xytext=(5, 5), textcoords="offset points", fontsize=8)
    for row in others:
        axes.plot(row.frame, row.off, "s", color="#909090", markersize=7)
        axes.annotate(f"{row.form[0]}, {row.form[1]}", (row.frame, row.off), xytext=(7, -3), textcoords="offset points", fontsize=8)
    for row in presets:
        axes.plot(row.frame, min(row.off, most), "*", color=REALTIME, markersize=13)
        axes.annotate(row.preset, (row.frame, min(row.off, most)), xytext=(8, 4), textcoords="offset points", fontsize=9, color=REALTIME)
    logarithmic(axes, "milliseconds on one core for a frame of 1/60 s, per 1000 particles", y_label)
    axes.legend(frameon=False, fontsize=8.5)
    return finish(figure)


def calibration(rows, what, forms=tuple(FORMS), equal=False, most=10):
    """The true error over what is known of it; `equal`: with the line on which they agree."""
    figure, axes = start(height=4.6)
    for form in forms:
        own = [row for row in rows if row.form == form and row.residual > 0]
        axes.plot([max(row.residual, 1e-8) for row in own], [min(row.seen, most) for row in own], "o", color=COLOURS[form], label=FORMS[form], markersize=4,
                  alpha=0.6, markeredgewidth=0)
    if equal:
        axes.plot([1e-5, 1], [1e-5, 1], color="#888888", linewidth=1)
    logarithmic(axes, what, "true error of the substep")
    axes.xaxis.set_major_formatter(FuncFormatter(percent if equal else lambda value, _: f"{value:.0e}"))
    axes.legend(frameon=False, fontsize=8.5)
    return finish(figure)


def error_over_iterations(rows, most=10):
    """One panel a form of multiplier, one line a substep."""
    figure, _ = start(height=4.2)
    figure.clear()
    panels = figure.subplots(1, 2, sharey=True)
    substeps = sorted({row.substep for row in rows})
    shades = pyplot.get_cmap("turbo")
    for axes, (form, title) in zip(panels, ((DEFAULT, "tensor (the default)"), (("gauss_seidel", "scalar"), "scalar (as in the paper)"))):
        for number, substep in enumerate(substeps):
            line = sorted((row for row in rows if row.form == form and row.substep == substep), key=lambda row: row.iterations)
            axes.plot([row.iterations for row in line], [min(row.seen, most) for row in line], "-o", markersize=3.5, linewidth=1.4,
                      color=shades(0.3 + 0.6 * number / len(substeps)), label=f"{1e3 * substep:g} ms")
        logarithmic(axes, "iterations", "true error of the substep" if form == DEFAULT else "")
        axes.set_title(title, fontsize=10)
        axes.grid(color="#888888", alpha=0.25, linewidth=0.6)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    panels[1].legend(frameon=False, fontsize=8, title="substep", title_fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return finish(figure)


def scaling(rows):
    figure, axes = start(height=3.4)
    for form, name in FORMS.items():
        own = sorted((row for row in rows if row.form == form), key=lambda row: row.particles)
        if own:
            axes.plot([row.particles for row in own], [1e9 * row.error for row in own], "-o", color=COLOURS[form], label=name, markersize=5)
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 1024:g} K"))
    axes.set_ylim(bottom=0)
    axes.set_xlabel("particles")
    axes.set_ylabel("ns a particle and substep")
    axes.legend(frameon=False, fontsize=8.5)
    return finish(figure)


def breakdown(of_each):
    """{name: rows of the stages}: a bar each; stages under 3 % of a step together."""
    figure, axes = start(height=0.75 * len(of_each) + 1.4)
    shades = pyplot.get_cmap("tab20")
    names = []
    for number, (name, rows) in enumerate(of_each.items()):
        left, small = 0.0, 0.0
        large = [row for row in rows if row.error >= 0.03]
        small = sum(row.error for row in rows if row.error < 0.03)
        for stage, share in [(row.case.removesuffix(" " + name), row.error) for row in large] + [("all others", small)]:
            if stage not in names:
                names.append(stage)
            axes.barh(number, share, left=left, color=shades(names.index(stage) % 20), label=stage if stage not in axes.get_legend_handles_labels()[1] else None)
            left += share
    axes.set_yticks(range(len(of_each)), list(of_each))
    axes.invert_yaxis()
    axes.xaxis.set_major_formatter(FuncFormatter(percent))
    axes.set_xlim(0, 1)
    axes.legend(frameon=False, fontsize=8, ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return finish(figure)
