"""A browser tab that only remembers: what viser would have been told."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np

A_PERSON = object()


class FakeHandle:
    """A widget or a scene node: attributes, and callbacks a test can call."""

    def __init__(self, **attributes: Any) -> None:
        self.__dict__.update(attributes)
        self.callbacks: list[Callable[[Any], None]] = []
        self.removed = False

    def on_update(self, callback: Callable[[Any], None]) -> None:
        self.callbacks.append(callback)

    on_click = on_upload = on_update

    def remove_drag_callback(self, _: str) -> None:
        self.callbacks.clear()

    def on_drag(self, button: str, *, modifier: str | None) -> Callable[[Any], None]:
        self.dragged = (button, modifier)
        return self.callbacks.append

    def remove(self) -> None:
        self.removed = True

    def set_by_person(self, value: Any) -> None:
        """What a click or a drag does."""
        self.value = value
        for callback in self.callbacks:
            callback(SimpleNamespace(client=A_PERSON, target=self))

    def __enter__(self) -> FakeHandle:
        return self

    def __exit__(self, *_: object) -> None:
        return None


class FakeGui:
    """Widgets by label, in the order in which they were added."""

    def __init__(self) -> None:
        self.widgets: dict[str, FakeHandle] = {}
        self.html: list[FakeHandle] = []

    def add_html(self, content: str, visible: bool = True, order: float = 0.0) -> FakeHandle:
        self.html.append(FakeHandle(content=content, visible=visible))
        return self.html[-1]

    def add_slider(self, label: str, min: float, max: float, step: float, initial: float, **kw: Any) -> Any:
        return self._add(label, value=initial, min=min, max=max, step=step, **{"disabled": False, **kw})

    def add_dropdown(self, label: str, options: Any, initial_value: Any = None, **kw: Any) -> FakeHandle:
        return self._add(label, value=initial_value or options[0], options=tuple(options), **kw)

    def add_checkbox(self, label: str, initial: bool, **kw: Any) -> FakeHandle:
        return self._add(label, value=initial, **kw)

    def add_button(self, label: str, visible: bool = True, **kw: Any) -> FakeHandle:
        return self._add(label, value=False, visible=visible, **kw)

    def add_text(self, label: str, initial: str, **kw: Any) -> FakeHandle:
        return self._add(label, value=initial, **kw)

    def add_upload_button(self, label: str, **kw: Any) -> FakeHandle:
        return self._add(label, value=None, **kw)

    def add_button_group(self, label: str, options: Any, **kw: Any) -> FakeHandle:
        return self._add(label, value=options[0], options=tuple(options), **kw)

    def add_folder(self, label: str, **kw: Any) -> FakeHandle:
        return self._add(label, **kw)

    def add_form(self, label: str | None, **kw: Any) -> FakeHandle:
        return FakeHandle(label=label, **kw)

    def add_progress_bar(self, value: float, **kw: Any) -> FakeHandle:
        return FakeHandle(value=value, **kw)

    def add_uplot(self, data: Any, series: Any, **kw: Any) -> FakeHandle:
        return self._add(f"plot {len(self.widgets)}", data=data, series=series, **kw)

    def _add(self, label: str, **attributes: Any) -> FakeHandle:
        self.widgets[label] = FakeHandle(label=label, **attributes)
        return self.widgets[label]


class FakeScene:
    """Nodes by name."""

    def __init__(self) -> None:
        self.nodes: dict[str, FakeHandle] = {}

    def __getattr__(self, method: str) -> Callable[..., FakeHandle]:
        if not method.startswith("add_"):
            raise AttributeError(method)
        return lambda name, *arguments, **kw: self._add(method, name, arguments, kw)

    def remove_by_name(self, name: str) -> None:
        self.nodes.pop(name).removed = True

    def _add(self, method: str, name: str, arguments: tuple[Any, ...], kw: dict[str, Any]) -> FakeHandle:
        attributes = {"wxyz": np.array([1.0, 0, 0, 0]), "position": np.zeros(3), "visible": True, **kw}
        if method in {"add_arrows", "add_line_segments"}:
            attributes["points"] = arguments[0]
        if method == "add_mesh_simple":
            attributes["vertices"], attributes["faces"] = arguments[:2]
        if method == "add_label":
            attributes["text"] = arguments[0]
        self.nodes[name] = FakeHandle(name=name, method=method, **attributes)
        return self.nodes[name]


class FakeClient:
    """One browser tab."""

    def __init__(self) -> None:
        self.gui = FakeGui()
        self.scene = FakeScene()
        self.camera = FakeHandle(
            position=np.zeros(3), look_at=np.zeros(3), fov=1.0, image_width=1280, image_height=800
        )

    @contextlib.contextmanager
    def atomic(self) -> Iterator[None]:
        yield

    def flush(self) -> None:
        return None
