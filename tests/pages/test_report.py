"""Pages of mfv report, shown in a headless browser (Debian's chromium, controlled by playwright)."""

from __future__ import annotations

import io
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mfv
from mfv import report
from mfv.commands import main
from mfv.load_history import kept_states

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

#: The browser: MFV_CHROMIUM if set, else the first of the usual names on the PATH.
CHROMIUM = os.environ.get("MFV_CHROMIUM") or next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)

#: A page that cannot be drawn fails after this time [ms].
PATIENCE = 120_000

needs_chromium = pytest.mark.skipif(not CHROMIUM, reason="there is no chromium on this machine (scripts/test.sh installs it)")

BODIES = """
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=41, half_width=0.01225 /
"""
TITLE = 'tan </script><b>bold</b> & "quoted"'
PRESSED = "&scene length_unit='mm', force_unit='N' /" + BODIES + "&step normal_force=1.0e-3 /\n&output history='none' /\n"
SHEARED = (
    f"&scene title='{TITLE}', coupling='goodman' /"
    + BODIES
    + """
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.8e-4 /
&step tangential_force=-2.8e-4, cycles=2 /
"""
)
SLIDING = SHEARED + "&step tangential_force=1.0e-3 /\n"
KINETIC = SHEARED.replace("law='coulomb', mu=0.7", "law='static_kinetic', mu_static=0.7, mu_kinetic=0.6")
DAHL = SHEARED.replace("law='coulomb', mu=0.7", "law='dahl', mu=0.7, stiffness=1000")


class Page:
    """A page in the browser, its console messages and its requests."""

    def __init__(self, browser, path: Path, **settings) -> None:
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.tab = browser.new_page(**settings)
        self.tab.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.tab.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(path.as_uri(), timeout=PATIENCE)
        self.tab.wait_for_selector("html[data-drawn]", timeout=PATIENCE)

    def charts(self) -> dict[str, int]:
        """Number of curves and maps that are drawn as SVG, by chart."""
        return self.tab.evaluate(
            """() => Object.fromEntries([...document.querySelectorAll('.chart')].map((chart) =>
                [chart.id, chart.querySelectorAll('svg .trace, svg .hm').length]))"""
        )

    def curve(self, chart: str, trace: str, values: str = "y") -> np.ndarray:
        """Values of a curve as the plotting library has them."""
        found = self.tab.evaluate(
            "([chart, trace, values]) => document.getElementById(chart).data.find((one) => one.name === trace)[values]",
            [chart, trace, values],
        )
        return np.array(found, dtype=float)

    def drawn(self, chart: str) -> list[str]:
        """What the curves of a chart look like: their paths."""
        return self.tab.evaluate(
            "(chart) => [...document.querySelectorAll(`#${chart} .scatterlayer path`)].map((path) => path.getAttribute('d'))",
            chart,
        )

    def move_to(self, state: int) -> None:
        """Move the slider, and wait for the words of that state."""
        self.tab.locator("#state").fill(str(state))
        self.wait_for_state(state)

    def wait_for_state(self, state: int) -> None:
        """Wait for the words of a state."""
        self.tab.wait_for_function(
            "(start) => document.getElementById('words').textContent.startsWith(start)",
            arg=f"state {state} of",
            timeout=PATIENCE,
        )

    def places(self, selector: str) -> list[list[int]]:
        """Left, top, right and bottom of the element of a selector, in a picture of the page."""
        return self.tab.evaluate(
            """(selector) => [...document.querySelectorAll(selector)].map((part) => part.getBoundingClientRect())
                .map((place) => [place.left, place.top + scrollY, place.right, place.bottom + scrollY].map(Math.round))""",
            selector,
        )

    def picture(self) -> np.ndarray:
        """What can be seen, as red, green and blue."""
        return np.asarray(Image.open(io.BytesIO(self.tab.screenshot(full_page=True))).convert("RGB"))


@pytest.fixture(scope="module")
def browser() -> Iterator[object]:
    """The browser without a window."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


def written(text: str, tmp_path: Path, *options: str) -> tuple[mfv.Result, Path]:
    """The result of a case, and its page."""
    mfv.run(text=text, output=tmp_path / "x.h5")
    assert main(["report", str(tmp_path / "x.h5"), *options]) == 0
    return mfv.read(tmp_path / "x.h5"), tmp_path / "x.html"


def colours_of(picture: np.ndarray) -> np.ndarray:
    """How many pixels of a picture have each of its colours."""
    return np.unique(picture.astype(np.int32) @ (1 << 16, 1 << 8, 1), return_counts=True)[1]


#: Traces of the charts that every page with friction has.
WITH_FRICTION = {"pressure": 1, "shear": 4, "curve": 2, "map": 1, "forces": 2, "dissipation": 1, "nodes": 2}


@needs_chromium
@pytest.mark.parametrize(
    ("text", "charts"),
    [
        (PRESSED, {"pressure": 2, "surfaces": 2, "map": 1}),
        (SHEARED, {**WITH_FRICTION, "pressure": 2, "shear": 5, "curve": 3, "cycles": 1, "work": 1}),
        (SLIDING, {**WITH_FRICTION, "pressure": 2, "shear": 5, "curve": 3, "cycles": 1, "work": 1}),
        (KINETIC, {**WITH_FRICTION, "pressure": 2, "shear": 6, "cycles": 1, "work": 1}),
        (DAHL, {**WITH_FRICTION, "pressure": 2, "cycles": 1, "work": 1}),
        ((EXAMPLES / "pin_in_bore.nml").read_text(), WITH_FRICTION),
    ],
    ids=["frictionless without history", "cycles", "early end", "static and kinetic", "creep", "rotation"],
)
def test_a_page_draws_what_there_is(text: str, charts: dict[str, int], browser: object, tmp_path: Path) -> None:
    result, path = written(text, tmp_path)
    page = Page(browser, path)
    assert page.complaints == []
    assert page.requests == [path.as_uri()]
    assert page.charts() == charts
    assert page.tab.inner_text("h1") == (result.title or "x.h5")
    assert page.tab.inner_text(".outcome").startswith(result.outcome)
    assert page.tab.locator("#state").get_attribute("max") == str(len(kept_states(result).steps))
    assert page.tab.inner_text("pre").strip() == text.strip()
    for name in result.certificate:
        assert page.tab.locator("tbody th", has_text=name).count() > 0
    page.tab.close()


@needs_chromium
def test_the_slider_leads_through_the_states(browser: object, tmp_path: Path) -> None:
    result, path = written(SHEARED, tmp_path)
    page = Page(browser, path)
    steps = result.steps
    seen = []
    for number in (len(steps), 1, 3):
        page.move_to(number)
        state = steps[number - 1]
        for chart, trace, values in (
            ("pressure", "pressure", state.pressure),
            ("shear", "shear traction", state.shear),
        ):
            x = page.curve(chart, trace, "x")
            shown = np.isclose(result.mesh.x[:, None], x, rtol=1e-6, atol=1e-9).any(axis=1)
            assert shown.sum() == x.size and np.all(state.status[~shown] == mfv.NodeStatus.OPEN)
            np.testing.assert_allclose(page.curve(chart, trace), values[shown], rtol=1e-6, atol=0.0)
        limit = page.curve("shear", "+μp")
        touching = np.isfinite(limit)
        np.testing.assert_allclose(limit[touching], 0.7 * state.pressure[shown][touching], rtol=1e-6)
        np.testing.assert_array_equal(page.curve("shear", "zones", "z"), [state.status[shown]])
        point = [page.curve("curve", "this state", values)[0] for values in "xy"]
        np.testing.assert_allclose(point, [state.shift, state.tangential_force], rtol=1e-6, atol=1e-12)
        seen.append(page.drawn("shear"))
    assert seen[0] != seen[1] != seen[2]
    np.testing.assert_array_equal(page.curve("map", "status", "z"), [state.status[shown] for state in steps])
    # By keyboard; playing continues by itself, and repeats.
    page.tab.focus("#state")
    page.tab.keyboard.press("ArrowLeft")
    page.wait_for_state(2)
    assert page.tab.locator("#state").get_attribute("aria-valuetext") == page.tab.inner_text("#words")
    page.tab.keyboard.press("ArrowRight")
    page.wait_for_state(3)
    page.move_to(len(steps))
    page.tab.click("#play")
    page.wait_for_state(2)
    page.tab.click("#play")
    assert page.tab.locator("#play").get_attribute("aria-pressed") == "false"
    assert page.complaints == []
    page.tab.close()


@needs_chromium
def test_a_page_is_readable_wide_and_narrow(browser: object, tmp_path: Path) -> None:
    path = written(SHEARED, tmp_path)[1]
    page = Page(browser, path, viewport={"width": 1300, "height": 800})
    for width in (1300, 390):
        page.tab.set_viewport_size({"width": width, "height": 800})
        page.tab.wait_for_function(
            "() => [...document.querySelectorAll('.main-svg')].every((one) => one.clientWidth <= innerWidth)",
            timeout=PATIENCE,
        )
        picture = page.picture()
        assert picture.shape[1] == width  # nothing hangs over
        assert len(colours_of(picture)) > 200 and picture.mean() > 200.0
        for left, top, right, bottom in page.places(".chart"):
            counts = colours_of(picture[top:bottom, left:right])
            assert len(counts) > 20 and counts.max() < 0.98 * counts.sum()  # not blank
        named = page.tab.locator("[role=group]:not([aria-label]), button:not([aria-label]):not(:has-text('play'))")
        assert named.count() == 0
    paper = page.tab.pdf(prefer_css_page_size=True)
    assert paper.startswith(b"%PDF") and len(paper) > 50_000
    assert page.complaints == []
    page.tab.close()


@needs_chromium
def test_a_chart_can_be_saved_and_cannot_be_sent_away(browser: object, tmp_path: Path) -> None:
    path = written(SHEARED, tmp_path)[1]
    page = Page(browser, path)
    buttons = page.tab.evaluate("() => [...document.querySelectorAll('#shear .modebar-btn')].map((one) => one.outerHTML)")
    assert len(buttons) == 4 and not any("hare" in button or "loud" in button for button in buttons)
    page.tab.hover("#shear")
    with page.tab.expect_download(timeout=PATIENCE) as saved:
        page.tab.locator("#shear .modebar-btn").first.click()
    saved.value.save_as(tmp_path / "shear.png")
    assert len(colours_of(np.asarray(Image.open(tmp_path / "shear.png").convert("RGB")))) > 20
    # Whatever asks for something is refused by the page itself.
    assert page.tab.evaluate("() => fetch('https://example.org/').then(() => 'sent', () => 'refused')") == "refused"
    assert all(url.startswith(("file:", "data:", "blob:")) for url in page.requests)
    page.tab.close()


@needs_chromium
def test_states_between_can_be_asked_for(browser: object, tmp_path: Path) -> None:
    result, path = written(SHEARED, tmp_path, "--states", "30")
    page = Page(browser, path)
    assert page.tab.locator("#state").get_attribute("max") == "30"
    np.testing.assert_allclose(page.curve("curve", "computed")[-1], result.summary.tangential_force, rtol=1e-6)
    page.move_to(8)  # five states press; three of the next five lead to three fifths of 2.8e-4
    assert "Q = 0.000168" in page.tab.inner_text("#words")
    assert page.charts()["cycles"] == 1 and page.complaints == []
    page.tab.close()


def test_a_page_is_one_file_without_addresses_to_load(tmp_path: Path) -> None:
    text = written(SHEARED, tmp_path)[1].read_text(encoding="utf-8")
    before, _ = text.split('<script type="application/json"')
    for loaded in ("src=", "href=", "@import", "url("):
        assert loaded not in before
    assert "default-src 'none'" in before
    assert "&lt;b&gt;bold&lt;/b&gt;" in before and "<b>bold" not in before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.h5", "x.html"]


def test_of_many_states_and_cycles_some_are_shown() -> None:
    result = mfv.run(text=SHEARED.replace("cycles=2", "cycles=130") + "&output states='reversals' /")
    text = report.page(result, "x.h5")
    assert f"{report.MOST_STATES} of {len(result.steps)} states are shown" in text
    assert f"{report.MOST_CYCLES} of 130 cycles" in text
    assert len(text) < 8_000_000


def test_a_missing_package_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    mfv.run(text=PRESSED, output=tmp_path / "x.h5")
    monkeypatch.delitem(sys.modules, "mfv.report", raising=False)
    monkeypatch.delattr(mfv, "report", raising=False)
    monkeypatch.setitem(sys.modules, "plotly", None)
    assert main(["report", str(tmp_path / "x.h5")]) == 2
    assert f"\"{sys.executable}\" -m pip install 'plotly' 'jinja2'" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.h5"]
