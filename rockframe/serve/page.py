"""The page of the server, in HTML: the form and the outcome of a run."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Final
from urllib.parse import urlencode

from rockframe.reports.page import banner
from rockframe.serve.controls import BASES, CONTROLS, PULSES, Control, TrialScene
from rockframe.units.display import with_superscripts

STYLE: Final = "/page.css"
SCRIPT: Final = "/page.js"


@dataclass(frozen=True)
class TrialOutcome:
    """The outcome of a run, for the page."""

    title: str
    verdict: str
    kind: str  # of the banner: good, bad or doubt
    warnings: Sequence[str]
    toml: str
    player: str  # a page


def trial_page(choice: TrialScene, motions: Mapping[str, str], outcome: str) -> str:
    """Return the whole page."""
    groups = [
        _fieldset("Body", "", _number_inputs(choice, "body")),
        _fieldset("Base", "", [_select("base", BASES, choice.base)]),
        _fieldset("Pads", "pads", _number_inputs(choice, "pads"), shown=choice.base == "pads"),
        _fieldset("Bed", "soil", _number_inputs(choice, "soil"), shown=choice.base == "soil"),
        _fieldset("Motion", "", [
            _select("motion", motions, choice.motion), *_number_inputs(choice, "motion"),
        ]),
        _fieldset("Pulse", "pulse", _number_inputs(choice, "pulse"), shown=choice.motion in PULSES),
    ]  # fmt: skip
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<title>rockframe</title>\n<link rel="stylesheet" href="{STYLE}">\n'
        f'<link rel="icon" href="data:,">\n<script src="{SCRIPT}" defer></script>\n'
        '</head>\n<body>\n<h1>Does it rock, does it fall?</h1>\n<div class="sides">\n'
        f'<form action="/" method="get" data-pulses="{" ".join(PULSES)}">\n'
        + "\n".join(groups)
        + '\n<button type="submit">Run</button>\n</form>\n'
        f'<main id="outcome" aria-live="polite">\n{outcome}\n</main>\n</div>\n</body>\n</html>\n'
    )


def outcome_html(outcome: TrialOutcome, query: Mapping[str, str]) -> str:
    """Return the part of the page with the outcome of a run."""
    address = escape(urlencode(query))
    cautions = "".join(
        banner("To be used with care", warning, "doubt") for warning in outcome.warnings
    )
    return (
        banner(outcome.title, outcome.verdict, outcome.kind)
        + cautions
        + f'\n<iframe title="Animation of the run" src="/player?{address}"></iframe>\n'
        "<h2>The scene as a file</h2>\n"
        f'<p><a href="/scene.toml?{address}" download="scene.toml">scene.toml</a>, for '
        "<code>rockframe run scene.toml</code></p>\n"
        f'<pre tabindex="0">{escape(outcome.toml)}</pre>'
    )


def faults_html(faults: Sequence[str]) -> str:
    """Return the part of the page with faults."""
    lines = "".join(f"<li>{escape(fault)}</li>" for fault in faults)
    return f'<div class="verdict doubt" role="alert"><strong>Not run</strong><ul>{lines}</ul></div>'


def _fieldset(title: str, name: str, pieces: Sequence[str], *, shown: bool = True) -> str:
    owned = f' data-of="{name}"' if name else ""
    hidden = "" if shown else " hidden"
    inner = "\n".join(pieces)
    return f"<fieldset{owned}{hidden}><legend>{title}</legend>\n{inner}\n</fieldset>"


def _select(name: str, known: Mapping[str, str], chosen: str) -> str:
    options = "".join(
        f'<option value="{value}"{" selected" if value == chosen else ""}>{escape(words)}</option>'
        for value, words in known.items()
    )
    title = "Stands on" if name == "base" else "Shaken by"
    return f'<label>{title}<select name="{name}">{options}</select></label>'


def _number_inputs(choice: TrialScene, group: str) -> list[str]:
    of_group = (control for control in CONTROLS if control.group == group)
    return [_number_input(control, choice.numbers[control.name]) for control in of_group]


def _number_input(control: Control, value: float) -> str:
    unit = f" [{escape(with_superscripts(control.unit))}]" if control.unit else ""
    ends = f'min="{control.low:g}" max="{control.high:g}"'
    return (
        f'<div class="number"><label for="{control.name}">{control.words}{unit}</label>'
        f'<input type="number" id="{control.name}" name="{control.name}" {ends} step="any" '
        f'value="{value:g}" required>'
        f'<input type="range" data-for="{control.name}" {ends} step="{control.step:g}" '
        f'value="{value:g}" aria-label="{control.words}, slider"></div>'
    )
