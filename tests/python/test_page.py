"""The page of a run: its numbers are those of the run, and texts of a system are never script."""

import base64
import hashlib
import html.parser
import json
import re

import numpy as np
import pytest

import achilles

PENDULUM = "double_pendulum"


class Page(html.parser.HTMLParser):
    """The tags of a page, the data and the script."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.scripts, self.texts, self._open = [], [], [], []
        self.feed(text)
        self.data = json.loads(self.scripts[0], parse_constant=lambda name: pytest.fail(f"{name} in the data"))
        for clip in self.data["clips"]:  # differences from instant to instant
            for entry in clip["shapes"]:
                if isinstance(entry, list) and not isinstance(entry[1][0], list):
                    entry[1] = np.array(entry[1], dtype=float).reshape(len(clip["t"]), -1).cumsum(axis=0)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag in ("script", "style"):
            self._open.append(tag)
            if tag == "script":
                self.scripts.append("")

    def handle_endtag(self, tag):
        if self._open and tag == self._open[-1]:
            self._open.pop()

    def handle_data(self, text):
        if self._open == ["script"]:
            self.scripts[-1] += text
        elif not self._open:
            self.texts.append(text)

    def moving(self, t, kind, picture):
        """The numbers of the shapes of a kind in a picture at time t, as the player computes them."""
        clip = [clip for clip in self.data["clips"] if clip["t"][0] <= t][-1]
        i = np.searchsorted(clip["t"], t, side="right") - 1
        found = []
        for entry in clip["shapes"]:
            shape = self.data["shapes"][entry[0] if isinstance(entry, list) else entry]
            if shape["in"] != picture or shape["kind"] != kind:
                continue
            if not isinstance(entry, list):
                found.append(np.array(shape["numbers"], dtype=float))
                continue
            now, following = entry[1][i], entry[1][min(i + 1, len(clip["t"]) - 1)]
            length = clip["t"][min(i + 1, len(clip["t"]) - 1)] - clip["t"][i]
            found.append(now + (min((t - clip["t"][i]) / length, 1.0) if length > 0 else 0.0) * (following - now))
        return found


def times_of(run, count=400):
    """Times of all parts of the run, and close to events, also between the bounces before a Zeno point."""
    events = [event.t for event in run.events]
    near = [t + step for t in events for step in (-1e-3, -1e-6, 0.0, 1e-6, 1e-3)]
    zeno = [t for event in run.events if event.kind == "zeno" for t in np.linspace(event.truncation.t, event.t, 20)]
    times = np.unique([*np.linspace(run.t[0], run.t[-1], count), *near, *zeno])
    return times[(times >= run.t[0]) & (times <= run.t[-1])]


def test_the_mechanism_is_where_the_run_is():
    run = achilles.simulate(PENDULUM)
    assert sum(event.kind == "zeno" for event in run.events) >= 1
    page = Page(run.html())
    x0, y0, unit = page.data["map"]
    L1, L2 = run.parameters["L1"], run.parameters["L2"]
    for t in times_of(run):
        theta1, theta2 = run(t).q
        knee = np.array([L1 * np.sin(theta1), -L1 * np.cos(theta1)])
        foot = knee + [L2 * np.sin(theta1 + theta2), -L2 * np.cos(theta1 + theta2)]
        segments = [shape for shape in page.moving(t, "path", 0) if len(shape) == 4]
        for segment, world in zip(segments, (knee, foot), strict=True):
            expected = np.array([x0, y0]) + unit * world * [1, -1]
            # A quarter of a pixel, half as much between two samples, and rounding; ten units are a pixel.
            assert np.abs(segment[2:] - expected).max() < 2.5 + 1.25 + 0.51, (t, segment, expected)


def test_the_dots_are_on_the_curves():
    run = achilles.simulate(PENDULUM)
    page = Page(run.html())
    times = times_of(run)
    for picture, name in ((1, "theta1"), (2, "theta2"), (3, "theta2'"), (4, "lambda")):
        dots = np.array([page.moving(t, "circle", picture)[0][:2] for t in times])
        for values, pixels, sign in ((times, dots[:, 0], 1), (run.evaluate(name, times), dots[:, 1], -1)):
            slope, offset = np.polyfit(values, pixels, 1)
            assert sign * slope > 0 and np.abs(slope * values + offset - pixels).max() < 6, (name, sign)


def test_events_and_words_are_those_of_the_run(program):
    run = achilles.simulate("ball_on_sine")
    page = Page(run.html())
    times = [float(attributes["data-t"]) for tag, attributes in page.tags if tag == "button" and "data-t" in attributes]
    assert times == [0.0, *(event.t for event in run.events), 20.0] == sorted(times)
    text = " ".join("".join(page.texts).split())
    lines = program("simulate", "ball_on_sine").splitlines()
    title, result = lines[0].split(": ", 1)
    assert title in text and result in text
    for line in lines[2:]:
        assert " ".join(line.split()) in text
    starts = [clip["t"][0] for clip in page.data["clips"]]
    for phase in run.phases:
        if phase.held:
            words = [clip["phase"] for clip, t in zip(page.data["clips"], starts) if abs(t - phase.start) < 1e-6]
            assert "in contact" in words, (phase.start, starts)
    assert "achilles html ball_on_sine" in text and page.data["start"] == 0 and page.data["end"] == 20 and page.data["speed"] == 1


def test_it_is_what_the_program_writes(program, tmp_path):
    run = achilles.simulate("ball_on_sine", values={"e": 0.3, "x'": 1.2}, end=12)
    text = run.html(tmp_path / "mine.html", views=["height"])
    program("html", "ball_on_sine", "--set", "e=0.3", "--set", "x'=1.2", "--end", "12", "--view", "height", "--out",
            str(tmp_path / "run.html"))
    assert (tmp_path / "run.html").read_bytes() == (tmp_path / "mine.html").read_bytes() == text.encode()
    assert run.html(views=["height"]) == text != run.html()
    assert len(achilles.simulate("ball_on_sine").html()) < 500_000
    with pytest.raises(achilles.InputError, match="this system has no view 'hieght'; did you mean 'height'"):
        run.html(views=["hieght"])


def test_what_is_wrong(program, tmp_path):
    told = program("html", "ball_on_sine", "--out", str(tmp_path / "run.png"), status=2)
    assert "a page for a browser, not a picture" in told and "achilles figure" in told
    assert "there is no folder" in program("html", "ball_on_sine", "--out", str(tmp_path / "no/run.html"), status=2)
    assert "no view 'hight'" in program("html", "ball_on_sine", "--view", "hight", "--out", str(tmp_path / "run.html"), status=2)
    assert list(tmp_path.iterdir()) == []


def test_a_page_that_allows_only_its_own_script(source):
    text = achilles.simulate("ball_on_sine").html()
    page = Page(text)
    (policy,) = [a["content"] for tag, a in page.tags if tag == "meta" and a.get("http-equiv") == "Content-Security-Policy"]
    script = (source / "app/pictures/player.js").read_text()
    assert page.scripts[1] == script and f"<script>{script}</script>" in text
    hashed = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert policy == f"default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src 'sha256-{hashed}'"
    assert (source / "app/pictures/player.css").read_text() in text


HOSTILE = "</script><script>alert(1)</script><img src=x onerror='alert(2)'>\\\"&amp;</style><!--"


def test_texts_of_a_stranger_are_only_texts(tmp_path):
    text = achilles.System("ball_on_sine").text
    text = re.sub("(?m)^title = .*", lambda _: f'title = "{HOSTILE}"', text)
    text = text.replace("drawing = [", f"""drawing = [{{shape = "text", at = ["x", "y"], text = "{HOSTILE}"}},""")
    text = text.replace("view = [", f"""view = [{{name = "{HOSTILE}", x = "t", y = ["x"]}},""")
    run = achilles.simulate(achilles.System(text, f"{tmp_path}/<script>alert(3)</script>.toml"))
    page = Page(run.html())
    plain = HOSTILE.replace('\\"', '"')
    assert run.system.title == plain and plain in "".join(page.texts)
    assert sum(tag == "script" for tag, _ in page.tags) == 2 == len(page.scripts)
    assert not any(tag in ("img", "iframe", "object", "embed", "link", "base", "form", "a") for tag, _ in page.tags)
    for tag, attributes in page.tags:
        assert not any(name.startswith("on") or name in ("src", "href", "srcdoc") for name in attributes), (tag, attributes)
    assert [shape["text"] for shape in page.data["shapes"] if shape["kind"] == "text"] == [plain]
    notebook = Page.__new__(Page)
    html.parser.HTMLParser.__init__(notebook)
    notebook.tags, notebook.scripts, notebook.texts, notebook._open = [], [], [], []
    notebook.feed(run._repr_html_())
    ((tag, attributes),) = notebook.tags
    assert tag == "iframe" and attributes["sandbox"] == "allow-scripts" and attributes["srcdoc"] == run.html()
    assert notebook.texts == [] and notebook.scripts == []


@pytest.mark.parametrize("name", ["ball_in_gusts", "kneed_leg", "spun_disc"])
def test_the_same_run_has_the_same_page(name):
    run = achilles.simulate(name, end=2)
    assert run.html() == run.html()


@pytest.mark.filterwarnings("ignore::achilles.AchillesWarning")
@pytest.mark.parametrize("name", sorted(achilles.gallery()))
def test_every_system_of_the_gallery_has_a_page(name):
    run = achilles.simulate(name, end=2)
    text = run.html()
    page = Page(text)
    clips, shapes = page.data["clips"], page.data["shapes"]
    assert len(text) < 6_000_000 and not re.search(r"\b(nan|inf)\b", page.scripts[0].lower())
    assert clips[0]["t"][0] == run.t[0] and abs(clips[-1]["t"][-1] - run.t[-1]) <= 1e-6
    for clip in clips:
        assert clip["t"] == sorted(clip["t"])
        for entry in clip["shapes"]:
            shape = shapes[entry[0] if isinstance(entry, list) else entry]
            if shape["kind"] == "path" and "counts" in shape:
                count = 2 * sum(shape["counts"])
                assert len(shape["numbers"]) == count if not isinstance(entry, list) else entry[1].shape[1] == count
    # Every name of a clip path is unique on the page.
    names = re.findall(r'<clipPath id="([^"]+)"', text)
    assert len(names) == len(set(names)) and set(re.findall(r"url\(#([^)]+)\)", text)) <= set(names)


def test_a_system_without_a_drawing_shows_its_plane():
    lines = achilles.System(PENDULUM).to_toml(expand=True).splitlines()
    text = "\n".join(lines)
    text = re.sub(r"(?ms)^drawing = \[.*?^\]\n", "", text)
    run = achilles.simulate(achilles.System(text), end=3)
    page = Page(run.html())
    assert page.data["world"] == -1 and not any(a.get("id") == "world" for _, a in page.tags)
    assert len(page.moving(1.0, "circle", 0)) == 1


def test_a_run_that_stops_says_so():
    with pytest.warns(achilles.AchillesWarning, match="stopped early"):
        run = achilles.simulate("ball_on_sine", max_impacts=3)
    text = " ".join("".join(Page(run.html()).texts).split())
    assert "stopped at t = " in text and "too many impacts" in text and "--max-impacts" in text
