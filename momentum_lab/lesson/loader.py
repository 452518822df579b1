"""Lessons from their scripts; whatever is wrong with a script is told with its file and line."""

from __future__ import annotations

import ast
import re
import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from momentum_lab.control.gains import declared_gains
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import InputError, LabError, LessonError
from momentum_lab.lesson.parsing import parsed
from momentum_lab.lesson.parts import (
    CONTROLS,
    VIEWS,
    Bound,
    Choice,
    Compare,
    Explain,
    Falls,
    Lesson,
    Measure,
    Number,
    Play,
    Prose,
    Run,
    Stands,
)
from momentum_lab.lesson.text import check_words
from momentum_lab.paths import LESSONS
from momentum_lab.robot.catalog import robot_names

_KINDS: dict[str, tuple[type, ...]] = {
    "RUNS": (Run,),
    "MEASURES": (Measure,),
    "STEPS": (Prose, Choice, Number, Play, Compare, Explain),
    "CLAIMS": (Bound, Stands, Falls),
}


def lesson_files(folder: Path = LESSONS) -> list[Path]:
    """The scripts of a folder, NN_title.py, in their order."""
    return sorted(path for path in folder.glob("*.py") if re.match(r"\d+_", path.name))


def lesson_folder(name: str | None) -> Path:
    """The folder that `--lessons` names, or the one that ships with the package.

    Raises:
        InputError: it is no folder.
    """
    if name is not None and not Path(name).is_dir():
        raise InputError("lessons", name, "a folder")
    return LESSONS if name is None else Path(name)


def headline(path: Path) -> tuple[str, str]:
    """Title and question of a lesson, from its docstring: the first line, and the next paragraph.

    Raises:
        LessonError: the script cannot be read.
    """
    docstring = ast.get_docstring(_tree(path)) or ""
    title, _, rest = docstring.partition("\n")
    return title.strip(), " ".join(rest.strip().partition("\n\n")[0].split())


def find_lesson(name: str, folder: Path = LESSONS) -> Path:
    """The script of a lesson, by its number, its file's name or its title.

    Raises:
        InputError: there is none.
    """
    files = lesson_files(folder)
    wanted = _plain(name)
    for path in files:
        number, _, slug = path.stem.partition("_")
        if name.strip() in (str(int(number)), number) or wanted in (_plain(path.stem), _plain(slug)):
            return path
    for path in files:
        with suppress(LessonError):  # one that cannot be read has no title
            if wanted == _plain(headline(path)[0]):
                return path
    known = ", ".join(path.stem for path in files) or f"nothing, {folder} has no NN_title.py"
    raise InputError("lesson", name, known)


def load_lesson(path: Path) -> Lesson:
    """A lesson from its script.

    Raises:
        LessonError: something is wrong with it; the message names file and line.
    """
    tree = _tree(path)
    title, question = headline(path)
    names: dict[str, Any] = {"__name__": path.stem, "__file__": str(path)}
    with located(path, ""):
        exec(compile(tree, str(path), "exec"), names)
    found = {name: _parts(path, tree, name, names) for name in _KINDS}
    number = int(path.stem.partition("_")[0]) if re.match(r"\d+_", path.name) else 0
    robots = _robots(path, tree, names.get("ROBOTS", ("talos", "g1")))
    lesson = Lesson(
        path,
        number,
        title,
        question,
        robots,
        found["RUNS"],
        found["MEASURES"],
        tuple(found["STEPS"]),
        tuple(found["CLAIMS"]),
    )
    _check(lesson, tree)
    return lesson


@contextmanager
def located(path: Path, words: str) -> Iterator[None]:
    """Whatever goes wrong in a lesson's script, as an error that names its file and line.

    Args:
        path: the script.
        words: a text of the script that stands where the cause is, if what fails was called from elsewhere.

    Raises:
        LessonError: something went wrong.
        LabError: something that is not the script's fault went wrong.
    """
    try:
        yield
    except (Exception, SystemExit) as error:
        lines = [
            frame.lineno or 1
            for frame in traceback.extract_tb(error.__traceback__)
            if frame.filename == str(path)
        ]
        if not lines and (isinstance(error, LabError) or not words):
            raise
        lines = lines or [_line_of_text(path, _tree(path), words, words)]
        if isinstance(error, InputError):
            raise _wrong(path, lines[-1], f"{error.argument} {error.given}", error.allowed) from error
        given = f"{type(error).__name__}: {error}"
        raise _wrong(path, lines[-1], given, "a script that runs") from error


def _tree(path: Path) -> ast.Module:
    try:
        tree: ast.Module = parsed(path.read_text(encoding="utf-8"), str(path))
        # A few errors are found by the compiler only, such as a return outside a function.
        compile(tree, str(path), "exec")
        return tree
    except OSError as error:
        raise InputError("lesson", path, f"a file that can be read ({error.strerror})") from error
    except SyntaxError as error:
        given = (error.text or "").strip() or error.msg
        raise _wrong(path, error.lineno or 1, given, f"Python ({error.msg})") from error
    except ValueError as error:
        raise _wrong(path, 1, "bytes that are no text", f"Python in UTF-8 ({error})") from error


def _parts(path: Path, tree: ast.Module, name: str, names: dict[str, Any]) -> Any:
    """One of the four collections of a script, with nothing in it that does not belong there."""
    plain: Any = dict if name in ("RUNS", "MEASURES") else tuple
    kinds = ", ".join(kind.__name__ for kind in _KINDS[name])
    allowed = f"{name} = a {plain.__name__} of {kinds}"
    parts: Any = names.get(name)
    line = _line_of_name(tree, name)
    if type(parts) is not plain or (not parts and name != "MEASURES"):
        given = f"no {name}" if name not in names else f"{name} = {parts!r}"
        raise _wrong(path, line, given, allowed)
    for part in _each(parts):
        if not isinstance(part, _KINDS[name]):
            raise _wrong(path, line, repr(part), allowed)
    return parts


def _robots(path: Path, tree: ast.Module, robots: Any) -> tuple[str, ...]:
    known = robot_names()
    if type(robots) is not tuple or not robots or any(robot not in known for robot in robots):
        given, allowed = f"ROBOTS = {robots!r}", f"ROBOTS = a tuple of {', '.join(known)}"
        raise _wrong(path, _line_of_name(tree, "ROBOTS"), given, allowed)
    return robots


def _each(parts: dict[str, Any] | tuple[Any, ...]) -> Iterable[Any]:
    return parts.values() if isinstance(parts, dict) else parts


def _check(lesson: Lesson, tree: ast.Module) -> None:
    """Refuse a title, a step or a claim that speaks of something that is not there."""
    if not lesson.title or not lesson.question:
        raise _wrong(lesson.file, 1, "no question", "a docstring: the title, an empty line, the question")
    if not any(isinstance(step, Play) for step in lesson.steps):
        given = "no Play"
        raise _wrong(lesson.file, _line_of_name(tree, "STEPS"), given, "at least one step that is played")
    for text in _texts(lesson):
        _check_text(lesson, tree, text)
    for word, allowed in _names(lesson):
        if word not in allowed:
            line = _line_of_text(lesson.file, tree, word, word)
            raise _wrong(lesson.file, line, word, f"one of {', '.join(allowed)}")


def _check_text(lesson: Lesson, tree: ast.Module, text: str) -> None:
    try:
        check_words(text, lesson.measures)
    except InputError as error:
        line = _line_of_text(lesson.file, tree, text, str(error.given))
        raise _wrong(lesson.file, line, error.given, error.allowed) from error


def _texts(lesson: Lesson) -> Iterator[str]:
    yield from (lesson.title, lesson.question)
    for part in (*lesson.steps, *lesson.claims):
        yield part.words if isinstance(part, Bound | Stands | Falls) else part.text
        if isinstance(part, Choice):
            yield from (option.text for option in part.options)


def _names(lesson: Lesson) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Every name that a step or a claim uses, and what it may be."""
    runs, measures = tuple(lesson.runs), tuple(lesson.measures)
    for part in (*lesson.steps, *lesson.claims):
        if isinstance(part, Play | Explain) and part.view is not None:
            yield part.view, VIEWS
        match part:
            case Play(run=run, controls=controls, beside=beside):
                yield run, runs
                if beside is not None:
                    yield beside, tuple(other for other in runs if other != run) or ("another run",)
                if run in runs:
                    yield from ((control, _controls(lesson.runs[run])) for control in controls)
            case Explain(run=run) | Stands(run=run) | Falls(run=run):
                yield run, runs
            case Compare(measures=compared):
                yield from ((name, measures) for name in compared)
            case Number(measure=name) | Bound(measure=name):
                yield name, measures


def _controls(run: Run) -> tuple[str, ...]:
    gains = controller_entry(run.for_robot(None).controller).gains
    return (*CONTROLS, *declared_gains(gains))


def _line_of_name(tree: ast.Module, name: str) -> int:
    """Where a script assigns a name; its first line if it does not."""
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(target, ast.Name) and target.id == name for target in targets):
            return node.lineno
    return 1


def _line_of_text(path: Path, tree: ast.Module, text: str, part: str) -> int:
    """The line of a script on which a part of one of its texts stands."""
    lines = path.read_text(encoding="utf-8").splitlines()
    plain = " ".join(text.split())
    texts = [
        node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    same = [node for node in texts if " ".join(str(node.value).split()) == plain]
    for node in same or [node for node in texts if plain in " ".join(str(node.value).split())]:
        places = range(node.lineno, (node.end_lineno or node.lineno) + 1)
        return next((place for place in places if part in lines[place - 1]), node.lineno)
    return 1


def _plain(name: str) -> str:
    return re.sub(r"[\W_]+", " ", name.lower()).strip()


def _wrong(path: Path, line: int, given: object, allowed: str) -> LessonError:
    return LessonError(f"{path}:{line}", given, allowed)
