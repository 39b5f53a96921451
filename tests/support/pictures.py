"""Pictures of pages, compared with those of the docs.

``TRUNNION_NEW_PICTURES=1 pytest tests/builder tests/viewer`` writes them anew,
``tests.support.paper_pictures`` those of papers.
"""

import base64
import os
from pathlib import Path

from playwright.sync_api import Browser

PICTURES = Path(__file__).parents[2] / "docs" / "pictures"

#: Both pictures are reduced to so many fields: letters of another font do not count, a part that is missing does.
_FIELDS = (64, 40)

_COMPARE = """async ([first, second, width, height]) => {
  const fields = async url => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d");
    context.imageSmoothingQuality = "high";
    context.drawImage(image, 0, 0, width, height);
    return context.getImageData(0, 0, width, height).data;
  };
  const [a, b] = [await fields(first), await fields(second)];
  let sum = 0, far = 0;
  for (let i = 0; i < a.length; i += 4) {
    const off = Math.max(...[0, 1, 2].map(k => Math.abs(a[i + k] - b[i + k])));
    sum += off;
    if (off > 48) far++;
  }
  return [sum / (a.length / 4), far / (a.length / 4)];
}"""


def differences(browser: Browser, first: bytes, second: bytes) -> tuple[float, float]:
    """Mean difference of the fields of two PNG files, of 255, and the share of fields that differ much."""
    page = browser.new_page()
    urls = [f"data:image/png;base64,{base64.b64encode(png).decode()}" for png in (first, second)]
    mean, share = page.evaluate(_COMPARE, [*urls, *_FIELDS])
    page.close()
    return float(mean), float(share)


def check_picture(browser: Browser, png: bytes, name: str) -> None:
    """Fail unless a picture looks like that of the docs."""
    reference = PICTURES / name
    if os.environ.get("TRUNNION_NEW_PICTURES"):
        reference.write_bytes(png)
    mean, share = differences(browser, png, reference.read_bytes())
    assert mean < 8.0, f"{name} differs by {mean:.1f} of 255 in the mean"
    assert share < 0.04, f"{name} differs in {share:.1%} of its fields"
