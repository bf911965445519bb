"""Follows all links of a folder of HTML pages that stay in it: to files, and to places in pages.

Zensical checks links from page to page only, not to pictures, scenes and folders.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The links of a page, and the names of the places in it."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places = {""}
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            if name in ("id", "name") and value is not None:
                self.places.add(value)


def main() -> None:
    root = Path(sys.argv[1]).resolve()
    # The page of an unknown address is shown at any address, so its links begin at the root.
    pages = {path: Page(path) for path in root.rglob("*.html") if path.name != "404.html"}
    followed, broken = 0, []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path.parent / unquote(parts.path) if parts.path else path
            target = target.resolve()
            if target.is_dir():
                target /= "index.html"
            places = pages[target].places if target in pages else {unquote(parts.fragment)}
            followed += 1
            if not target.is_file() or unquote(parts.fragment) not in places:
                broken.append(f"{path.relative_to(root)}: {link}")
    print(f"{len(pages)} pages, {followed} links, {len(broken)} of them broken")
    sys.exit("\n".join(broken) or None)


main()
