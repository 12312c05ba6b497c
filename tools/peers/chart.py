"""Chart of the comparison: run time against noise, and rays per second."""

from pathlib import Path

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.fonttype"] = "none"
matplotlib.rcParams["svg.hashsalt"] = "peers"
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib import ticker  # noqa: E402

COLOURS = {
    "sunfleck": "#0072b2",
    "sunfleck, own mesh": "#56b4e9",
    "LESS, 100 wraps": "#d55e00",
    "LESS, 10 wraps": "#e69f00",
    "LESS": "#d55e00",
    "Mitsuba": "#009e73",
    "Embree": "#555555",
}


def draw_noise(panel: plt.Axes, rows: list[dict]) -> None:
    """Median and range of seconds against noise, one line for each program."""
    for program in dict.fromkeys(row["program"] for row in rows):
        points = sorted((row for row in rows if row["program"] == program), key=lambda row: row["seconds"])
        seconds = np.array([row["seconds"] for row in points])
        spread = np.abs(np.array([[row["seconds_min"], row["seconds_max"]] for row in points]).T - seconds)
        noise = [100 * row["noise"] for row in points]
        panel.errorbar(seconds, noise, xerr=spread, fmt="o-", markersize=4, color=COLOURS[program], label=program)
    panel.set_xscale("log")
    panel.set_yscale("log")
    low, high = panel.get_xlim()
    bottom, top = panel.get_ylim()
    for level in 10.0 ** np.arange(-4.0, 8.0, 0.25):
        line = np.array([low, high])
        panel.plot(line, level / np.sqrt(line), ":", color="0.8", linewidth=0.8, zorder=0)
    for axis in (panel.xaxis, panel.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        axis.set_minor_locator(ticker.NullLocator())
    panel.set_xlim(low, high)
    panel.set_ylim(bottom, top)
    panel.set_xlabel("seconds")
    panel.set_ylabel("sampling noise, rms (%)")
    panel.grid(color="0.93")
    panel.legend(frameon=False, fontsize=8)


def draw_rays(panel: plt.Axes, rows: list[dict]) -> None:
    """Rays per second of the image with the most samples: bars of the median, lines from the least to the most."""
    names = [row["program"] for row in rows]
    rates = np.array([row["rays"] / row["seconds"] / 1e6 for row in rows])
    limits = np.array([[row["rays"] / row["seconds_max"], row["rays"] / row["seconds_min"]] for row in rows]).T / 1e6
    panel.bar(names, rates, yerr=np.abs(limits - rates), color=[COLOURS[name] for name in names], width=0.6, capsize=4)
    for index, rate in enumerate(rates):
        panel.annotate(f"{rate:.2f}", (index, rate / 2), ha="center", color="white")
    panel.tick_params(axis="x", labelsize=8)
    panel.set_ylabel("million rays per second")
    panel.grid(axis="y", color="0.93")
    panel.set_axisbelow(True)


def draw(path: Path, summary: list[dict], settings: str) -> None:
    """One row of panels for each scene: its products, then the rates of its image."""
    scenes = list(dict.fromkeys(row["scene"] for row in summary))
    products = list(dict.fromkeys(row["product"] for row in summary))
    columns = len(products) + 1
    shape = (4.6 * columns, 3.8 * len(scenes) + 0.5)
    figure, panels = plt.subplots(len(scenes), columns, figsize=shape, squeeze=False, layout="constrained")
    for line, scene in zip(panels, scenes):
        of_scene = [row for row in summary if row["scene"] == scene]
        for panel, product in zip(line, products):
            panel.set_title(f"{scene}: {product}", fontsize=10)
            rows = [row for row in of_scene if row["product"] == product]
            if rows:
                draw_noise(panel, rows)
            else:
                panel.set_axis_off()
        most = max(row["count"] for row in of_scene if row["product"] == "image")
        rows = [row for row in of_scene if row["product"] == "image" and row["count"] == most and row["rays"]]
        line[-1].set_title(f"{scene}: rays of the image", fontsize=10)
        draw_rays(line[-1], rows)
    figure.suptitle(f"Time against sampling noise; dotted: slope -1/2. {settings}", fontsize=10)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
