"""The end of the lab does not wait for tabs that answer no more: a phone that sleeps, a client that does not read."""

from __future__ import annotations

import viser

# A tab that is awake says goodbye in milliseconds; viser would wait 6 s for one that is not, s.
_PATIENCE = 0.5


def part(server: viser.ViserServer) -> None:
    """Cut the connections that are still there a moment from now; to be called right before `server.stop`."""
    loop = server.get_event_loop()
    loop.call_soon_threadsafe(lambda: loop.call_later(_PATIENCE, _cut, server))


def _cut(server: viser.ViserServer) -> None:
    """Abort every connection, those of half an opening handshake included; in the loop's thread."""
    live = server._websock_server._live_connections.values()
    everyone = {connection for tab in live for connection in tab.server.handlers}
    for connection in everyone:
        connection.transport.abort()  # nothing happens to one that is closed already
