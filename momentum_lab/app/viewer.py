"""What has a scene to draw into: one browser tab, or a server that nobody watches and that keeps what is drawn."""

from __future__ import annotations

import viser

Viewer = viser.ClientHandle | viser.ViserServer
