"""The page of a class: ten thousand rows in a real browser, and no name that becomes markup."""

import json
import re
import shutil
import time
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.whole_class.explained import EXPLANATION, NO_CHANGE
from gz_course.grader.whole_class.gradebook import as_csv
from gz_course.grader.whole_class.index import INDEX, as_page, write_index
from gz_course.tests.generated_class import names

CHROMIUM = shutil.which("chromium")
COUNT = 10_000
DEADLINE = 100_000  # [ms] for anything in the browser
SPARE = 20  # how many times longer than for an empty page it may take to open ten thousand rows


def results(exercise, count):
    """Invented results; a hundredth could not be graded."""
    found = []
    for number, name in zip(range(count), names(), strict=False):
        score = None if number % 100 == 99 else number % 5 * 25
        points = {} if score is None else {check.id: check.points * (number % 5) / 4 for check in exercise.checks}
        found.append({
            "student": f"{name} <{number}>", "id": str(number), "submission": "x", "score": score, "points": points,
            "outcome": "infra" if score is None else "graded", "diagnosis": "</script><script>stop()" * (number % 2),
            "folder": f"folder {number} %?#", "sha256": "", "truth_sha256": "",
        })  # fmt: skip
    return found


def data_of(page):
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])


def test_what_the_page_holds(exercise, tmp_path):
    made = results(exercise, 150)
    write_index(tmp_path, exercise, made, ["html"])
    page = (tmp_path / INDEX).read_text(encoding="utf-8")
    assert [path.name for path in tmp_path.iterdir()] == [INDEX]
    assert page.count("<script") == page.count("</script>") == 2 and "stop()" in page
    assert not re.search(r"(src|href)=", page), "nothing is loaded from elsewhere"
    data = data_of(page)
    assert [row[0] for row in data["rows"]] == [row["student"] for row in made]
    assert data["page"] == "report.html" and data["rows"][99][2] is None
    assert as_page(exercise, made, ["html"]) == page, "equal results, equal bytes"
    assert data_of(as_page(exercise, made, []))["page"] == "report.json"


def test_groups_by_the_change_that_would_help(exercise, tmp_path):
    made = results(exercise, 3)
    for number, change in ((0, "another sign for angular.z"), (2, NO_CHANGE)):
        folder = tmp_path / made[number]["folder"]
        folder.mkdir()
        kept = {"key": "k", "group": change, "sentences": ["Line 2 decides it."]}
        (folder / EXPLANATION).write_text(json.dumps(kept))
    (tmp_path / made[1]["folder"]).mkdir()
    (tmp_path / made[1]["folder"] / EXPLANATION).write_text("[")
    write_index(tmp_path, exercise, made, [])
    data = data_of((tmp_path / INDEX).read_text(encoding="utf-8"))
    assert data["groups"] == [["another sign for angular.z", 1], [NO_CHANGE, 1]]
    assert [row[7] for row in data["rows"]] == [0, None, 1]
    assert data["rows"][0][4].startswith("Line 2 decides it.")


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--headless=new", "--no-sandbox"])
        yield browser
        browser.close()


@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here: apt-get install chromium")
@pytest.mark.parametrize("number", ["03", "05"])
def test_it_fits_a_small_screen_and_opens_all_of_a_student_in_one_place(root, browser, tmp_path, number):
    exercise = find_exercise(number, root)
    made = results(exercise, 60)
    facts = {"submitted": "2026-11-20T12:00:00", "attempts": 2, "changes": ["stops 0 -> 5"]}
    made = [each | facts | {"diagnosis": f"It drives {n}.5 m/s. More."} for n, each in enumerate(made)]
    for each in made:
        (tmp_path / each["folder"]).mkdir()
        for name in ("report.html", "report.json", "a run.rrd") if each["score"] is not None else ():
            (tmp_path / each["folder"] / name).touch()
    write_index(tmp_path, exercise, made, ["html"])
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(DEADLINE)
    faults = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto((tmp_path / INDEX).as_uri())
    page.wait_for_selector("#page:has-text('Page')")
    assert page.eval_on_selector("html", "page => page.scrollWidth") <= 1280
    assert page.eval_on_selector(".scroll", "table => table.scrollWidth - table.clientWidth") <= 0
    text = page.inner_text("main")
    assert "Hardest checks: " in text and "Handed in from 2026-11-20 12:00" in text and "2 attempts each" in text
    bars = page.eval_on_selector_all(".bar span:first-child", "all => all.map(one => Number(one.textContent))")
    assert sum(bars) == 60 and len(bars) == 10
    page.click("#alike summary")
    page.click("#faults button")
    page.click("button.more >> nth=1")
    page.wait_for_selector("tr.details")
    told = page.inner_text("tr.details")
    assert "stops 0 -> 5" in told and "course show 'folder 1 %?#/a run.rrd'" in told
    assert f'"{made[1]["student"]}"' in told or f"{made[1]['student']},{exercise.name}," in told
    links = page.eval_on_selector_all("a", "all => all.map(one => one.href)")
    files = [Path(unquote(urlsplit(link).path)) for link in links]
    assert len(files) > 50 and all(file.is_file() for file in files), "no link is dead"
    assert {file.name for file in files} == {"report.html", "report.json", "a run.rrd"}
    assert faults == []
    page.close()


@pytest.mark.proof
@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here: apt-get install chromium")
def test_ten_thousand_rows_in_a_browser(exercise, browser, tmp_path):
    made = results(exercise, COUNT)
    write_index(tmp_path, exercise, made, ["html"])
    (tmp_path / "empty").mkdir()
    write_index(tmp_path / "empty", exercise, [], ["html"])
    assert len(as_csv(exercise, made).splitlines()) == COUNT + 1
    context = browser.new_context(offline=True, viewport={"width": 1280, "height": 800})
    page = context.new_page()
    page.set_default_timeout(DEADLINE)
    faults, asked = [], []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda line: faults.append(line.text))
    page.on("request", lambda request: asked.append(request.url))

    def opened(folder):
        began = time.monotonic()
        page.goto((folder / INDEX).as_uri())
        page.wait_for_selector("#page:has-text('Page')")
        return time.monotonic() - began

    took = {folder: min(opened(folder) for _ in range(2)) for folder in (tmp_path / "empty", tmp_path)}
    print({str(folder): f"{seconds:.2f} s" for folder, seconds in took.items()})
    assert took[tmp_path] < SPARE * max(took[tmp_path / "empty"], 0.05)

    def seen():
        return page.eval_on_selector_all("#rows tr th", "each => each.map(one => one.textContent)")

    def told(what):
        page.get_by_text(what).first.wait_for()  # the page's policy lets nobody evaluate a text as a function

    wanted = [row["student"] for row in made]
    told("10000 submissions, 1900 with full marks")
    assert seen() == wanted[:50]
    page.click("#after")
    told("Page 2 of 200")
    assert seen() == wanted[50:100]
    page.fill("#search", "zoe 7324")  # without the dots that the name has
    told("1 of 10000 submissions")
    (one,) = seen()
    assert one in wanted and "Zoë" in one
    link = page.get_attribute("#rows a", "href")
    assert link.startswith("./folder%20") and link.endswith("%20%25%3F%23/report.html")
    page.fill("#search", "")
    told("Page 1 of 200")
    for direction in ("ascending", "descending"):
        page.click("#head button:has-text('Score')")
        page.wait_for_selector(f"th[aria-sort={direction}]")
        scores = page.eval_on_selector_all("#rows tr", "each => each.map(one => Number(one.cells[2].textContent))")
        assert scores == [0 if direction == "ascending" else 100] * 50
    page.select_option("#outcome", "infra")
    told("100 of 10000 submissions")
    page.click("#after")
    told("Page 2 of 2")
    assert page.is_disabled("#after") and len(seen()) == 50
    page.select_option("#outcome", "")
    page.select_option("#size", "1000")
    told("Page 1 of 10")
    assert len(seen()) == 1000
    page.screenshot(path=str(tmp_path / "page.png"))
    assert faults == [] and {url.partition(":")[0] for url in asked} == {"file"}
    context.close()
