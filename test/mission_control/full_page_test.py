#!/usr/bin/python3
"""What the page shows of a made-up drive at the Full level, in Chromium. Called by full_page_test.sh."""

import argparse
import pathlib
import time

from page_driver import Page, check, wait_for

# Of a layer's picture on the map: its place in the page, how many pixels the grid has, and its opacity.
LAYERS = """
    return [...document.querySelectorAll(".grid-layer")].map((e) => {
      const box = e.getBoundingClientRect();
      return { src: e.src, x: box.x + box.width / 2, y: box.y + box.height / 2, width: box.width, pixels: e.naturalWidth,
               opacity: +getComputedStyle(e).opacity };
    });
"""
ROVER = """
    const box = document.getElementById("map").getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];
"""


def layer(page, name):
    return next((found for found in page.script(LAYERS) if f"/{name}.png" in found["src"]), None)


def look(page, pictures, name):
    for kind in ["elevation", "traversability", "hazards"]:
        wait_for(f"{name}: the {kind} layer is there", lambda: (layer(page, kind) or {"pixels": 0})["pixels"] > 0, 60)
    wait_for(f"{name}: the NavCam's picture", lambda: page.script("return document.getElementById('camera').width") == 640, 60)
    wait_for(f"{name}: difficulty, SLAM and correction", lambda: page.number("difficulty") > 0 and page.text("slam") == "ok"
             and page.text("correction") == "0.36 m", 60)
    direction = page.text("navcam-at")
    check(f"{name}: the NavCam's direction", direction == "ahead" or "°" in direction)
    rover, terrain = page.script(ROVER), layer(page, "traversability")
    check(f"{name}: the map of 20 m lies around the rover",
          max(abs(terrain["x"] - rover[0]), abs(terrain["y"] - rover[1])) < 0.15 * terrain["width"])
    check(f"{name}: no panel covers another", page.overlaps() == [] or print(page.overlaps()))
    page.picture(pictures / f"full_{name}.png")


def follow(page):
    before = layer(page, "elevation")["src"]
    wait_for("a new map brings a new picture", lambda: layer(page, "elevation")["src"] != before, 60)
    page.script("window.fetched = []; new PerformanceObserver((list) => list.getEntries().forEach("
                "(e) => window.fetched.push(e.name))).observe({ type: 'resource' })")
    time.sleep(6.0)
    pictures = [name for name in page.script("return window.fetched") if "/layer/elevation" in name]
    check(f"and is fetched once ({len(pictures)} in 6 s)", 1 <= len(pictures) <= 4 and len(set(pictures)) == len(pictures))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--pictures", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    url = f"http://127.0.0.1:{arguments.port}/"
    pages = []
    try:
        for name, width, height in [("desk", 1440, 900), ("phone", 390, 844)]:
            pages.append(Page(url, width, height))
            look(pages[-1], arguments.pictures, name)
        follow(pages[0])
        loud = pages[0].complaints()
        check("the browser has nothing to complain about", loud == [] or print(loud))
    finally:
        for page in pages:
            page.driver.quit()


main()
