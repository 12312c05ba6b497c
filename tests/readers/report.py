"""Opens reports in a browser and checks what a reader would notice.

    python tests/readers/report.py REPORT.html [REPORT.html ..]

Each page is parsed strictly by html5lib, and shown by Chromium at three widths, light and dark: no message on the
console, no request, nothing wider than the window, no picture broken, text with enough contrast. Exit code 77 says that a
module or the browser is missing.
"""

import shutil
import sys
from pathlib import Path

try:
    import html5lib
    from playwright.sync_api import sync_playwright
except ImportError as missing:
    print(f"{missing.name} is missing")
    sys.exit(77)

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
WIDTHS = (360, 768, 1400)

FACTS = """() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const ids = all("[id]").map((element) => element.id);
  const light = (colour) => {
    const part = (value) => (value /= 255) <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    const [r, g, b] = colour.match(/[\\d.]+/g).map(Number);
    return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b);
  };
  const contrast = (element) => {
    let behind = element;
    while (behind && getComputedStyle(behind).backgroundColor === "rgba(0, 0, 0, 0)") behind = behind.parentElement;
    const back = light(getComputedStyle(behind ?? document.body).backgroundColor);
    const style = getComputedStyle(element);
    const front = light(element instanceof SVGElement ? style.fill : style.color);
    return (Math.max(front, back) + 0.05) / (Math.min(front, back) + 0.05);
  };
  const texts = all("p, a, td, th, dt, dd, li, figcaption, caption, summary, h1, h2, svg text:not(.inside):not(.halo)");
  return {
    width: document.documentElement.scrollWidth,
    window: innerWidth,
    headings: all("h1, h2, h3, h4").map((heading) => Number(heading.tagName[1])),
    repeated: ids.filter((id, at) => ids.indexOf(id) !== at),
    broken: all("img").filter((img) => img.complete && img.naturalWidth === 0).length,
    unnamed: all("img:not([alt]), svg:not([aria-label]):not([aria-hidden])").length,
    figures: all("figure svg:not(.swatch)").length,
    faint: texts.filter((element) => element.textContent.trim() && contrast(element) < 4.5)
      .map((element) => element.outerHTML.slice(0, 80)),
    lines: all(".line").filter((line) => {
      const style = getComputedStyle(line), paper = getComputedStyle(document.body).backgroundColor;
      const [a, b] = [light(style.stroke), light(paper)].sort((x, y) => y - x);
      return (a + 0.05) / (b + 0.05) < 3;
    }).length,
  };
}"""


def shown(browser, path, width, scheme, script=True):
    """Facts of a page as a reader has it."""
    context = browser.new_context(
        viewport={"width": width, "height": 800}, color_scheme=scheme, java_script_enabled=script
    )
    page = context.new_page()
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: said.append(request.url) if request.url[:5] not in ("file:", "data:") else None)
    page.goto(path.resolve().as_uri())
    return context, page, said


def check(browser, path):
    html5lib.HTMLParser(strict=True).parse(path.read_text(encoding="utf-8"))
    figures = set()
    for width in WIDTHS:
        for scheme in ("light", "dark"):
            context, page, said = shown(browser, path, width, scheme)
            facts = page.evaluate(FACTS)
            where = f"{path} at {width} px, {scheme}: "
            assert not said, where + str(said)
            assert facts["width"] <= facts["window"], f"{where}{facts['width']} px wide"
            assert not facts["repeated"], f"{where}ids {facts['repeated']}"
            assert facts["broken"] == 0, where + "broken pictures"
            assert facts["unnamed"] == 0, where + "pictures without a text"
            assert not facts["faint"], f"{where}faint: {facts['faint'][:5]}"
            assert facts["lines"] == 0, where + "faint lines"
            levels = facts["headings"]
            assert levels[0] == 1 and levels.count(1) == 1, where + str(levels)
            assert all(b <= a + 1 for a, b in zip(levels, levels[1:])), where + str(levels)
            figures.add(facts["figures"])
            context.close()
    assert len(figures) == 1, f"{path}: {figures} figures"
    behave(browser, path)
    context, page, said = shown(browser, path, 768, "light", script=False)
    assert page.locator("figure svg:not(.swatch)").count() in figures, "figures need no script"
    context.close()
    return figures.pop()


def behave(browser, path):
    """Points have texts, tables sort, pictures open and close."""
    context, page, said = shown(browser, path, 1400, "light")
    points = page.locator(".pt .hit, .part, .cell")
    if points.count():
        points.first.scroll_into_view_if_needed()
        # Texts vanish while the page scrolls.
        page.wait_for_timeout(200)
        points.first.hover(force=True)
        assert page.locator("#tip").is_visible() and page.locator("#tip").inner_text().strip(), "no text at a point"
    button = page.locator("th button").first
    if button.count():
        table = page.locator("table.sortable:has(th button)").first
        cells = lambda: table.locator("tbody tr td:first-child").all_inner_texts()
        before = cells()
        button.click()
        assert sorted(cells()) == sorted(before), "rows are lost"
        rising = cells()
        button.click()
        assert len(set(before)) < 2 or cells() != rising, "a table does not sort"
    opened = page.locator(".picture a.open")
    if opened.count():
        small = opened.first.locator("img").bounding_box()
        opened.first.click()
        large = opened.first.locator("img").bounding_box()
        assert large["width"] > small["width"], (small, large)
        page.keyboard.press("Escape")
        assert opened.first.locator("img").bounding_box()["width"] == small["width"], "a picture stays open"
    assert not said, said
    context.close()


def main(paths):
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        print("there is no Chromium")
        sys.exit(77)
    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        for path in paths:
            print(f"{path}: {check(chromium, path)} figures, {path.stat().st_size} bytes")
        chromium.close()


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
