#!/usr/bin/env python3
"""Makes docs/thesis/pictures.md and its pictures: every example of the thesis's chapters 2 to 4 before and after, with the views
of the thesis's figures and histograms.

    scripts/thesis_pictures.py [NAME ...]      all examples and the page, or the pictures of those named

Needs the built programs (./run.sh or ./test.sh) and no display. What is shown, and how a method is set, stands in
sample_meshes/MANIFEST; from where it is looked at, below. Meshes too large to be kept are made first, for which Debian's
package python3-gmsh is needed. All numbers on the page are those that curvewright-cli told in the same run.
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CLI = os.path.join(ROOT, "build", "bin", "curvewright-cli")
SAMPLES = os.path.join(ROOT, "sample_meshes")
FOLDER = os.path.join(ROOT, "docs", "thesis")

WHOLE_SIZE, NEAR_SIZE = "600x450", "480x450"
COLORS = "48"

# ---------------------------------------------------------------------------------------------------------------------
# What the pictures show. A view is its words, and options of "render". One that looks at elements ("--focus") does so
# in the state that it names, and shows the same place in the others.


class View:
    def __init__(self, key, words, *options, size=None, of=None, legend=None):
        self.key, self.words, self.options, self.of = key, words, list(options), of
        is_whole = key == "whole"
        self.size = size or (WHOLE_SIZE if is_whole else NEAR_SIZE)
        self.has_legend = is_whole if legend is None else legend


def whole(*options, words="The whole mesh", size=None):
    return View("whole", words, *options, size=size)


def near(words, *options, of=None, size=None):
    return View("near", words, *options, of=of, size=size)


def middle(words, *options, of=None, size=None):
    return View("middle", words, *options, of=of, size=size)


def cut(words, *options, size=None):
    return View("cut", words, *options, size=size)


VIEWS = {
    # Chapter 2: what is seen from near is where the result of convex weights is worst, or where the thesis looks.
    "naca_p2": [whole("--zoom", "0.5,0,0.62", words="The airfoil"), near("The leading edge", "--zoom", "0.02,0,0.045")],
    "moving_circle": [whole(), near("Ahead of the circle", "--focus", "worst:3", "--margin", "2", of="convex")],
    "moving_circles1": [whole(), near("Between two circles", "--zoom", "0,0.17,0.13")],
    "moving_circles2": [whole(), near("Where it is worst", "--focus", "worst", "--margin", "4", of="convex")],
    "screw": [whole(words="The surface", size="480x540"), cut("Cut lengthwise", "--cut", "y", size="360x540")],
    "moving_sphere": [whole("--cut", "y", words="Cut through the middle"),
                      cut("At the sphere", "--cut", "y", "--view", "front", "--zoom", "0.05,0,0,0.42")],
    "moving_spheres": [whole("--cut", "z", "--view", "-50,50", words="Cut through the spheres"),
                       cut("At a sphere", "--cut", "z", "--view", "top", "--zoom", "0.42,0.48,0,0.3")],
    "shell1": [whole(words="The surface"), cut("Cut lengthwise", "--cut", "y")],
    "shell2": [whole("--view", "front", words="The surface"), cut("Cut lengthwise", "--cut", "y", "--view", "front")],
    "circle_family": [whole(), near("At the rim", "--zoom", "0.95,0,0.1")],
    "sphere_family": [whole(words="The surface"), cut("Cut through the middle", "--cut", "x")],
    # Chapters 3 and 4: the tangled elements.
    "annulus_ch3": [whole(), near("A tangled element at the inner circle", "--focus", "worst", "--margin", "0.7", of="tangled")],
    "naca_le": [whole(), near("The leading edge", "--focus", "tangled", "--margin", "0.5", of="tangled")],
    "mech_ch3": [whole(), near("The ligament at the rim", "--focus", "worst", "--margin", "1", of="tangled")],
    "plate1": [whole(), near("The inner ring", "--focus", "tangled", "--margin", "0.4", of="tangled")],
    "plate2": [whole(), near("The inner ring", "--focus", "tangled", "--margin", "0.4", of="tangled")],
    "plate2_p2": [whole(), near("The inner ring", "--focus", "tangled", "--margin", "0.4", of="tangled")],
    "beam": [whole(size="640x320"),
             near("The left end", "--focus", "element:512,477", "--margin", "0.15", of="tangled", size="360x320")],
    "annulus": [whole(), near("The inner circle", "--focus", "tangled", "--margin", "0.1", of="tangled")],
    "mech_ch4": [whole(), middle("The bore", "--focus", "tangled", "--margin", "0.3", of="tangled"),
                 near("The ligament", "--focus", "worst", "--margin", "1", of="tangled")],
    "bike_gear": [whole(), middle("The upper third", "--zoom", "0,0.68,0.42"),
                  near("At the bore", "--focus", "worst", "--margin", "2", of="tangled")],
    "pressure_plate": [whole(), middle("The middle", "--zoom", "0,0,0.6"),
                       near("A hole near the rim", "--focus", "worst", "--margin", "1.5", of="tangled")],
    "gear": [whole(), middle("The bore and its holes", "--focus", "tangled", "--margin", "0.4", of="tangled"),
             near("A ligament", "--focus", "worst", "--margin", "3", of="tangled")],
    "brake_rotor": [whole(), middle("The hub", "--focus", "tangled", "--margin", "0.1", of="tangled"),
                    near("At a hole", "--focus", "worst", "--margin", "2", of="tangled")],
    "bl_airfoil": [whole("--zoom", "0.5,0,0.62", words="The airfoil"),
                   near("The leading edge", "--focus", "tangled", "--margin", "1", of="tangled")],
}

CHAPTERS = {
    2: ("Warping", "A boundary moves or becomes curved, and affine or convex combinations of neighbours move the interior after it. "
                   "The mesh before is straight-sided."),
    3: ("Untangling by unsigned angles", "Tangled elements are hatched and ringed. Plates and beam were valid before they were "
                                         "deformed."),
    4: ("Untangling by signed angles", "β weighs the angles of the elements against the distance that nodes may move."),
}

# ---------------------------------------------------------------------------------------------------------------------


class Failure(Exception):
    pass


def cli(*arguments):
    """The JSON of a command. Elements that are tangled (status 3) are what this is about."""
    done = subprocess.run([CLI, *arguments, "--json", "--quiet"], capture_output=True, text=True)
    if done.returncode not in (0, 3):
        raise Failure(f"curvewright-cli {' '.join(arguments)}\n{done.stderr.strip()}")
    return json.loads(done.stdout)


def lowered(text):
    return text[0].lower() + text[1:]


def number(value):
    return f"{value:.3f}".replace("-", "−")


class State:
    """A mesh of an example on its way."""

    def __init__(self, key, title, file, quality):
        self.key, self.title, self.file, self.quality = key, title, file, quality

    def sentence(self):
        its = self.quality
        count = its["valid"] + its["invalid"] + its["undecided"]
        validity = (f"{its['invalid']:,} of {count:,} elements tangled" if its["invalid"] else
                    f"all {count:,} elements valid" if not its["undecided"] else f"{its['undecided']:,} undecided")
        return f"min {number(its['min'])}, mean {number(its['mean'])}; {validity}"


class Example:
    def __init__(self, card, work):
        self.card, self.name, self.work = card, card["name"], work
        self.mesh = os.path.join(SAMPLES, card["mesh"])
        self.deformation = os.path.join(SAMPLES, card["deformation"])

    def file(self, key):
        return os.path.join(self.work, f"{self.name}_{key}.msh")

    def original(self):
        return State("initial", "Before", self.mesh, cli("quality", self.mesh)["scaled_jacobian"])

    def deformed(self, key, title):
        cli("deform", self.mesh, "--deformation", self.deformation, "-o", self.file(key))
        return State(key, title, self.file(key), cli("quality", self.file(key))["scaled_jacobian"])

    def warped(self, weights):
        file = self.file(weights)
        published = ["--distance-power", "0", "--sharing-power", "0"] if self.card["as_published"] else []
        told = cli("warp", self.mesh, "--deformation", self.deformation, "--weights", weights, *published, "-o", file)
        return State(weights, f"{weights.capitalize()} weights", file, told["scaled_jacobian"])

    def untangled(self, tangled, key, title, *options):
        told = cli("untangle", tangled.file, "--method", self.card["method"], *options, "-o", self.file(key))
        return State(key, title, self.file(key), told["scaled_jacobian"])

    def run(self):
        """Shown states, and those of the histograms."""
        if self.card["task"] == "warp":
            states = [self.original(), self.warped("affine"), self.warped("convex")]
            return states, [states[0], self.deformed("moved", "Boundary moved, interior not"), *states[1:]]
        tangled = self.deformed("tangled", "Tangled")
        before = [tangled]
        if self.name in ("plate1", "plate2", "plate2_p2", "beam"):
            before.insert(0, self.original())
        if self.card["method"] == "unsigned-angle":
            literal = ["--literal"] if self.card["as_published"] else []
            title = "Unsigned angles" + ("" if literal else ", several starts")
            after = [self.untangled(tangled, "result", title, *literal)]
        else:
            betas = [0.1, 0.5, 0.9] if self.name == "annulus" else [self.card["beta"]]
            after = [self.untangled(tangled, f"beta{100 * beta:.0f}" if len(betas) > 1 else "result",
                                    f"Signed angles, β = {beta:.5f}".rstrip("0"), "--beta", str(beta)) for beta in betas]
        return before + after, [tangled] + after

    def draw(self, view, states):
        focus = None
        for state in sorted(states, key=lambda state: state.key != view.of):  # the one that is focused first
            options = focus or view.options
            told = cli("render", state.file, "-o", os.path.join(FOLDER, self.picture(state, view)), "--size", view.size,
                       "--palette", COLORS, *([] if view.has_legend else ["--no-legend"]), *options)
            if view.of and not focus:
                center = told["view"]["center"][:3 if self.card["dimension"] == 3 else 2]
                focus = ["--zoom=" + ",".join(repr(x) for x in [*center, told["view"]["radius"]])]

    def picture(self, state, view):
        return f"pictures/{self.name}_{state.key}_{view.key}.png"

    def make(self):
        """The example's section of the page."""
        states, compared = self.run()
        for view in VIEWS[self.name]:
            self.draw(view, states)
        histogram = f"pictures/{self.name}_histograms.svg"
        titles = [word for state in compared for word in ("--title", state.title)]
        cli("histogram", *[state.file for state in compared], "-o", os.path.join(FOLDER, histogram), *titles)
        return self.section(states, compared, histogram)

    def section(self, states, compared, histogram):
        card = self.card
        shape = {2: "triangles", 3: "tetrahedra"}[card["dimension"]]
        figures = " and ".join(card["figures"])
        if "2.2" in card["figures"]:  # plots of times
            figures += " (timings of such meshes)"
        count = compared[0].quality["valid"] + compared[0].quality["invalid"] + compared[0].quality["undecided"]
        lines = [f"### {card['title']}", "",
                 f"Figure{'s' if len(card['figures']) > 1 else ''} {figures}; {count:,} {shape} of order {card['order']}, sample "
                 f"`{self.name}`. What to look for: {lowered(card['look_for'])}", ""]
        for state in states:
            pictures = [(view, self.picture(state, view)) for view in VIEWS[self.name]]
            widths = [int(view.size.split("x")[0]) / int(view.size.split("x")[1]) for view, _ in pictures]
            lines += [f"**{state.title}**: {state.sentence()}.", ""]
            lines.append(" ".join(
                f'<img src="{file}" width="{98 * width / sum(widths):.1f}%" title="{view.words}" '
                f'alt="{card["title"]}, {lowered(state.title)}: {lowered(view.words)}">'
                for (view, file), width in zip(pictures, widths)))
            lines.append("")
        words = "; ".join(lowered(view.words) for view in VIEWS[self.name])
        lines += [f"*Left to right: {words}. Below: histograms of the scaled Jacobian, on one scale.*", "",
                  f'<img src="{histogram}" width="98%" alt="{card["title"]}: histograms">', ""]
        return "\n".join(lines)


def page(cards, sections):
    text = ["# The thesis's examples in pictures", "",
            "The examples of chapters 2 to 4 of M. J. Stees's thesis ([references](../REFERENCES.md)), each before and after, set up "
            "as the samples are, with the views of the thesis's figures. Colours are the scaled Jacobian, min J / max J; tangled "
            "elements are hatched. The meshes are ours, made after the thesis's figures, so numbers differ a little from the "
            "thesis's. `scripts/thesis_pictures.py` made this page and all of its pictures; the numbers are what "
            "`curvewright-cli` printed meanwhile.", ""]
    for chapter, (title, introduction) in CHAPTERS.items():
        names = [card for card in cards if card.get("chapter") == chapter]
        text += [f"- [Chapter {chapter}: {title}](#chapter-{chapter}-{title.lower().replace(' ', '-')}): "
                 + ", ".join(f"[{card['title']}](#{anchor(card['title'])})" for card in names)]
    for chapter, (title, introduction) in CHAPTERS.items():
        text += ["", f"## Chapter {chapter}: {title}", "", introduction, ""]
        text += [sections[card["name"]] for card in cards if card.get("chapter") == chapter]
    return "\n".join(text).rstrip() + "\n"


def anchor(title):
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def make_meshes(cards):
    """Those that are not kept."""
    missing = [card["name"] for card in cards if not os.path.exists(os.path.join(SAMPLES, card["mesh"]))]
    if not missing:
        return
    print("Making the meshes of", ", ".join(missing), flush=True)
    if subprocess.run(["/usr/bin/python3", "-c", "import gmsh"], capture_output=True).returncode != 0:
        raise Failure(f"The meshes of {', '.join(missing)} are made by Gmsh: install python3-gmsh, or name other examples.")
    subprocess.run(["/usr/bin/python3", os.path.join(SAMPLES, "generate.py"), *missing], check=True)


def main():
    parser = argparse.ArgumentParser(description="Makes docs/thesis/pictures.md and its pictures.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="draw these examples only, and leave the page alone")
    names = parser.parse_args().names
    with open(os.path.join(SAMPLES, "MANIFEST"), encoding="utf-8") as file:
        all_cards = [card for card in json.load(file)["samples"] if "chapter" in card]
    known = {card["name"] for card in all_cards}
    if missing := known - VIEWS.keys():
        raise Failure(f"From where to look at {', '.join(sorted(missing))}? VIEWS does not say.")
    if unknown := set(names) - known:
        raise Failure(f"There is no example {', '.join(sorted(unknown))}; there are {', '.join(sorted(known))}.")
    if not os.access(CLI, os.X_OK):
        raise Failure(f"{CLI} is not there: ./run.sh builds it.")
    cards = [card for card in all_cards if not names or card["name"] in names]
    make_meshes(cards)
    os.makedirs(os.path.join(FOLDER, "pictures"), exist_ok=True)
    sections = {}
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        running = {pool.submit(Example(card, work).make): card["name"] for card in cards}
        for done in concurrent.futures.as_completed(running):
            sections[running[done]] = done.result()
            print(f"{len(sections)} of {len(cards)}: {running[done]}", flush=True)
    if not names:
        with open(os.path.join(FOLDER, "pictures.md"), "w", encoding="utf-8") as file:
            file.write(page(cards, sections))


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(str(failure))
