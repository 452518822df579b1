"""Viser shows HTML as it is: every word is escaped."""

from __future__ import annotations

from momentum_lab.app import html
from momentum_lab.app.marks import STYLES

EVIL = "<img src=x onerror=alert(1)>"


def test_words_are_escaped():
    for text in (
        html.status_line("fallen", EVIL, "vermillion"),
        html.sentence(EVIL),
        html.changes([EVIL]),
        html.plot_title(EVIL, [(EVIL, "red", False)]),
        html.slider_ends(EVIL, EVIL),
    ):
        assert "<img" not in text
        assert "&lt;img" in text


def test_status_has_a_sign_a_colour_and_words():
    text = html.status_line("border", "CoP on the toes", "orange")
    assert "▲ CoP on the toes" in text
    assert html.COLORS["orange"] in text
    assert 'data-status="border"' in text


def test_time_line():
    running = html.time_line(1.234, 0.996, 1.0, playing=True)
    assert "simulated time \u2007\u2007<b>1.23 s</b> · 1.00 × real time<" in running
    slow = html.time_line(1.0, 0.25, 0.25, playing=True)
    assert 'data-time="1.234"' in running  # to the millisecond, for programs that read the page
    assert "0.25 × real time · at 1/4" in slow
    failed = html.time_line(1.0, 1.0, 1.0, playing=True, failures=3)
    assert ">3 steps unsolved<" in failed
    assert html.COLORS["vermillion"] not in failed  # a lecture is no alarm: the status says what matters
    assert "unsolved" not in running
    assert "paused" in html.time_line(1.0, 0.25, 1.0, playing=False)


def test_legend_has_a_symbol_and_a_name_per_mark():
    text = html.legend(STYLES, explained=True)
    assert text.count("<svg") == len(STYLES)
    for style in STYLES.values():
        assert f"<b>{style.label}</b>" in text
        assert style.help.split(";")[0].replace("'", "&#x27;") in text
        assert style.css in text


def test_nothing_changed_is_said():
    assert "as the scenario has it" in html.changes([])
