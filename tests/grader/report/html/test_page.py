"""The HTML report: well-formed, self-contained, readable without eyes or colours, and deaf to what a student wrote."""

import base64
import dataclasses
import hashlib
import json
import re
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as XML

import pytest
import rerun as rr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.report.html import page
from gz_course.grader.report.html.animation import animation
from gz_course.grader.report.html.from_above import Map
from gz_course.grader.report.html.page import as_html
from gz_course.tests.grader.report.handmade import NASTY, nasty, result, score_of, write_run

VOID = {"meta", "br", "img", "link", "hr", "input"}
SHAPES = {"rect", "line", "text", "path", "polygon", "polyline", "circle"}
TAGS = {
    "html", "head", "meta", "title", "style", "body", "a", "header", "main", "footer", "section", "p", "h1", "h2", "h3",
    "div", "table", "thead", "tbody", "tr", "th", "td", "span", "strong", "br", "figure", "figcaption", "svg", "pre",
    "code", "ul", "li", "dl", "dt", "dd", "img", "g", "button", "input", "label", "select", "option",
    "output", "script", "details", "summary",
} | SHAPES  # fmt: skip


class Strict(HTMLParser):
    """Notes every element, and complains about what a browser would have to guess at."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.faults, self.elements, self.texts = [], [], [], []
        self.feed(text)
        self.close()
        self.faults += [f"<{tag}> is never closed" for tag in self.open]

    def handle_starttag(self, tag, attributes):
        if tag not in TAGS:
            self.faults.append(f"<{tag}> is not expected")
        names = [name for name, _ in attributes]
        if len(set(names)) < len(names):
            self.faults.append(f"<{tag}> has an attribute twice")
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in SHAPES:
            self.faults.append(f"<{tag}/> closes itself")
        self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes something else")

    def handle_data(self, data):
        if self.open[-1:] not in (["style"], ["script"]):
            self.texts.append(data)

    def handle_comment(self, data):
        self.faults.append("a comment")

    def unknown_decl(self, data):
        self.faults.append("a declaration")

    def handle_pi(self, data):
        self.faults.append("a processing instruction")

    def all(self, *tags):
        return [attributes for tag, attributes in self.elements if tag in tags]

    @property
    def text(self):
        return " ".join("".join(self.texts).split())


def read(text):
    """Parse a page and check what must be true of every one."""
    parsed = Strict(text)
    assert parsed.faults == []
    assert text.startswith("<!doctype html>\n<html lang=")
    for tag, attributes in parsed.elements:
        for name, value in attributes.items():
            assert not name.startswith("on") and name not in ("srcset", "action", "formaction", "style"), (tag, name)
            if name in ("src", "href"):
                assert re.match(r"#\w|data:image/(jpeg|png);base64,[A-Za-z0-9+/=]*$", value), (tag, value)
    ids = [attributes["id"] for _, attributes in parsed.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    for _, attributes in parsed.elements:
        if "aria-labelledby" in attributes:
            assert attributes["aria-labelledby"] in ids
        if attributes.get("href", "").startswith("#"):
            assert attributes["href"][1:] in ids
    assert all(image.get("alt") for image in parsed.all("img"))
    assert all(svg.get("aria-hidden") or svg.get("aria-label") for svg in parsed.all("svg"))
    assert all(cell.get("scope") for cell in parsed.all("th"))
    levels = [int(tag[1]) for tag, _ in parsed.elements if re.fullmatch("h[1-6]", tag)]
    assert levels.count(1) == 1 and all(b - a <= 1 for a, b in pairwise(levels))
    for drawing in re.findall(r"<svg.*?</svg>", text, re.DOTALL):
        XML.fromstring(drawing)
    assert "default-src 'none'" in parsed.all("meta")[2]["content"]
    assert not re.search("[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]", text)
    return parsed


def test_it_tells_everything(make_report):
    parsed = read(as_html(make_report(lines=[(1.0, "[INFO] [teleop]: hello"), (2.0, "ValueError: no")])))
    for words in (
        "50 of 100 points", "The bad one: was 0.5.", "Title of good", "pass", "Title of bad", "FAIL", "is 0.5",
        "Hint for bad.", "1.25 s", "node.py", "2.00 s ValueError: no", "mujoco 4.0.0", "level D", "ab" * 32,
    ):  # fmt: skip
        assert words in parsed.text, words
    assert "Hint for good." not in parsed.text
    assert "never expected" not in parsed.text


def test_it_loads_nothing_and_runs_nothing_but_the_animation(make_report):
    text = as_html(make_report())
    assert "http://" not in text and "https://" not in text
    assert "@import" not in text and "url(" not in text and "javascript:" not in text
    (script,) = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    sha256 = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{sha256}'\"" in text, "the browser runs this script only"
    assert text.count("<script") == 2, "it and its data"


def test_the_run_can_be_played(make_report):
    text = as_html(make_report())
    run = re.search(r'<figure class="run.*?</figure>', text, re.DOTALL)[0]
    data = json.loads(re.search(r'<script type="application/json">(.*?)</script>', run, re.DOTALL)[1])
    assert (data["end"], data["count"]) == (4.0, 101)
    assert len(data["shapes"]) == run.partition("</svg>")[0].partition('class="moving"')[2].count("<polygon") == 1
    (rows,), (corners,) = data["links"], [corners for _, corners in data["shapes"]]
    assert len(rows) == 8 * 101 and len(corners) % 3 == 0
    assert rows[6:8] == [0, 0] and rows[-2:] == [2, 0]
    assert data["robot"][:3] == [0, 0, 0] and data["robot"][-3:] == [2, 0, 0]
    (scan,) = data["scans"]
    assert len(scan["at"]) == len(scan["dots"]) == 41 and all(len(dots) == 4 for dots in scan["dots"])
    moments = re.findall(r'<button type="button" value="([\d.]+)">', run)
    assert moments == ["0.0", "1.25", "2.0", "4.0"]
    assert 'role="group" aria-label="The run, played" hidden' in run, "without scripts it is a picture"


def test_a_plot_shows_band_and_moment_of_the_verdict(make_report):
    text = as_html(make_report())
    plots = re.findall(r'<svg class="plot".*?</svg>', text, re.DOTALL)
    assert len(plots) == 4  # two checks, two speeds
    assert 'class="band"' in plots[1] and "FAIL at 1.25 s" in plots[1] and 'class="curve c0"' in plots[1]
    assert "forward speed [m/s] over 4 s" in plots[1] and "Wanted: 0.45 to 0.55, 0.5 s to 3 s." in plots[1]
    assert 'class="curve c1"' in plots[2], "the command beside the truth"
    assert "command, /cmd_vel/linear/x" in text


def test_of_several_robots_each_has_its_own_commands(make_report):
    listened = {"listened": {topic: "geometry_msgs/msg/Twist" for topic in ("/cmd_vel", "/robot/cmd_vel")}}
    assert "command, /cmd_vel/linear/x" not in as_html(make_report(facts=listened))


def test_the_moments_of_the_run_are_drawn(make_report):
    text = as_html(make_report())
    parsed = read(text)
    maps = re.findall(r'<svg class="map".*?</svg>', text, re.DOTALL)
    assert len(maps) == 5  # the run; start, verdict, middle, end
    for words in ("0.00 s. Start", "1.25 s. Title of bad: failed", "2.00 s. Middle", "4.00 s. End"):
        assert words in parsed.text
    assert "from x = 0.00 m, y = 0.00 m to x = 2.00 m, y = 0.00 m, 2.00 m in all" in parsed.text
    assert "x = 0.60 m, y = 0.00 m, heading 0°" in parsed.text
    assert all(drawing.count("<polygon") == 2 for drawing in maps), "the box and the robot"
    assert all(drawing.count("h0") == 2 for drawing in maps), "what the lidar sees"


def test_camera_frames_are_shown_if_they_were_recorded(make_report):
    pictures = read(as_html(make_report())).all("img")
    assert len({picture["src"] for picture in pictures}) == 4
    assert pictures[0]["alt"] == "Picture of /camera/image at 0.00 s of simulated time."


def test_what_is_no_picture_is_left_out(make_report, monkeypatch):
    monkeypatch.setattr("gz_course.tests.grader.report.handmade.JPEG", b"<svg onload=alert(1)>")
    assert read(as_html(make_report())).all("img") == []


def test_full_marks(make_report):
    report = make_report(score_of(result("a", True), result("b", True)))
    text = read(as_html(report)).text
    assert "100 of 100 points" in text and "Every check is passed." in text and "FAIL" not in text


def test_nothing_was_run(not_run):
    parsed = read(as_html(not_run))
    assert "SyntaxError" in parsed.text and "nothing was run" in parsed.text and "0 of 100" in parsed.text
    assert parsed.all("svg") == [] and parsed.all("img") == []


@pytest.mark.parametrize("outcome", ["timeout", "tamper", "memory", "protocol", "infra"])
def test_every_outcome_is_a_sentence(make_report, outcome):
    score = score_of(result("a", False, at_s=None), result("b", False, bands=()), outcome=outcome, diagnosis="Why.")
    text = read(as_html(make_report(score, seconds=0.5))).text
    assert page.OUTCOMES[outcome] in text


def test_several_trials_stand_side_by_side(make_report):
    fine = score_of(result("good", True), result("bad", True))
    poor = score_of(result("good", True), result("bad", False, at_s=2.5), diagnosis="Poor.")
    report = make_report(poor, trials=("calm", "windy"), scores=[fine, poor])
    text = as_html(report)
    parsed = read(text)
    assert "run 2 times" in parsed.text
    assert "calm 3 100 of 100 graded none" in parsed.text
    assert "windy 4 50 of 100 graded Title of bad" in parsed.text
    assert "Title of bad (windy)" in parsed.text and "Title of good (calm)" in parsed.text
    assert "What your node said (trial windy)" in parsed.text
    assert "FAIL at 2.50 s" in text


def test_a_note_is_told(make_report):
    assert "has changed since" in read(as_html(make_report(notes=("The manifest has changed since.",)))).text


def test_it_differs_from_the_first_in_host_facts_only(make_report):
    report = make_report(lines=[(1.0, "hello")])
    again = as_html(dataclasses.replace(report, host=None, submission="node.py"))
    first, _, _ = as_html(report).partition("<footer>")
    assert again.partition("<footer>")[0] == first
    assert "known only to the report made when the submission was run" in again


def test_a_flood_is_shortened(make_report):
    lines = [(i / 1000, f"line {i}") for i in range(3000)]
    text = as_html(make_report(lines=lines, facts={"lines_dropped": 7}))
    parsed = read(text)
    assert "(2880 lines are left out here; the recording has them all)" in parsed.text
    assert "(7 more lines are not recorded: the log is too long)" in parsed.text
    assert "line 0 " in parsed.text and "line 2999" in parsed.text and "line 1500" not in parsed.text
    assert len(text) < 200_000


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(texts=st.lists(nasty, min_size=6, max_size=6), line=st.text(st.characters(codec="utf-8")))
def test_whatever_a_student_writes_is_text(make_report, texts, line):
    measured, expected, diagnosis, submission, note, name = texts
    bad = result("bad", False, measured)
    bad = dataclasses.replace(bad, finding=dataclasses.replace(bad.finding, expected=expected))
    score = score_of(result("good", True), bad, diagnosis=diagnosis)
    report = make_report(
        score, lines=[(1.0, line), *((1.0, text) for text in NASTY)], submission=f"/home/{submission}/{name}",
        notes=(note,), versions={"mujoco": name},
    )  # fmt: skip
    parsed = read(as_html(report))
    assert sum(tag in ("h1", "h2", "pre", "img") for tag, _ in parsed.elements) == 14
    assert len(parsed.all("script")) == 2
    assert "<script>alert(1)</script>" in parsed.text and "{{ 7 * 7 }}" in parsed.text


def test_names_of_topics_are_text(make_report, tmp_path):
    report = make_report()
    path = write_run(tmp_path / "topic.rrd", facts={"listened": {"/<b>x": "geometry_msgs/msg/Twist"}})
    trial = dataclasses.replace(report.trials[0], recording=path)
    read(as_html(dataclasses.replace(report, trials=(trial,))))


STYLE = Path(page.__file__).with_name("page.css").read_text()


def palettes():
    """The colours of each :root block in turn, each on top of the first: light, dark, print."""
    found = []
    for block in re.findall(r":root\s*{(.*?)}", STYLE, re.DOTALL):
        found.append((found[0] if found else {}) | dict(re.findall(r"--([\w-]+):\s*(#[0-9a-f]{6})", block)))
    return found


def luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    """Contrast ratio as the Web Content Accessibility Guidelines define it."""
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("palette", palettes(), ids=["light", "dark", "print"])
def test_texts_and_lines_stand_out(palette):
    texts = {"paper": ("ink", "soft", "link", "good", "bad"), "panel": ("ink", "soft", "bad"), "floor": ("soft",)}
    texts |= {"good-back": ("good", "ink"), "bad-back": ("bad", "ink")}
    faint = [(b, t) for b, names in texts.items() for t in names if contrast(palette[b], palette[t]) < 4.5]
    lines = ("c0", "c1", "c2", "c3", "good", "bad")
    faint += [("paper", line) for line in lines if contrast(palette["paper"], palette[line]) < 3]
    faint += [("floor", line) for line in ("path", "scan") if contrast(palette["floor"], palette[line]) < 3]
    assert faint == []


def test_there_are_three_palettes_and_each_colour_is_defined():
    assert len(palettes()) == 3
    assert set(re.findall(r"var\(--([\w-]+)\)", STYLE)) <= palettes()[0].keys()


def gated(gate):
    bad = result("bad", False, "it never drove", at_s=None, gated=True)
    return score_of(dataclasses.replace(bad, spec=dataclasses.replace(bad.spec, parameters={"gate": gate})))


@pytest.mark.parametrize(
    ("gate", "wanted"),
    [
        ({"signal": "truth/robot/distance", "reaches": 5}, "at least 5, 0 s to 4 s"),
        ([{"check": "x"}, {"signal": "truth/robot/x", "falls_to": -1.0}], "at most -1, 0 s to 4 s"),
        ({"check": "x"}, "0.45 to 0.55"),
    ],
)
def test_a_check_that_failed_at_its_gate_shows_the_gate(make_report, gate, wanted):
    text = as_html(make_report(gated(gate)))
    read(text)
    assert f"wanted: {wanted}" in text and "Hint for bad." not in text


def test_a_crowd_that_drives_for_long_still_fits(tmp_path):
    with Recorder(tmp_path / "crowd.rrd", "robot0") as recorder:
        for number in range(60):
            recorder.static(f"/world/robot{number}/base/visual", rr.Boxes3D(half_sizes=[[0.2, 0.3, 0.5]]))
        for second in range(0, 600, 200):
            recorder.set_time(second * 10**9)
            for number in range(60):
                recorder.pose(f"/world/robot{number}", (second / 7, number / 3, 0.1), (1.0, 0.0, 0.0, 0.0))
    drawn = Map(Recording(tmp_path / "crowd.rrd"), "robot0")
    data = animation(drawn, 600.0, 640)
    assert len(json.loads(data)["links"]) == 60
    assert len(data) < 1_000_000
