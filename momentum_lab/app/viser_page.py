"""What viser's page calls its own parts: style sheets and scripts of the lab find them by these names only here.

Viser promises none of them. A new version of it is looked at with this file beside it.
"""

from __future__ import annotations

ROW = ".mantine-Flex-root"
"""A name and its widget."""
FOLDED = "[role=button][aria-label^='Expand panel ']"
"""The bar of a panel that is folded away."""
UNFOLDED = "[role=button][aria-label^='Collapse panel ']"
"""The bar of a panel on a phone that is not."""
SHEET = "[style*='width: 20em']"
"""On a phone: the one sheet that holds all panels."""
PHONE = "@media(max-width:36em)"
"""Where viser draws that sheet."""
DARK_PAGE = "[data-mantine-color-scheme=dark]"
"""The whole page."""
