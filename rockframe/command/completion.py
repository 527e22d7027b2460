"""Scripts by which shells complete commands, options and files, from their declarations."""

import argparse
from typing import Final

from rockframe.command.answer import Answer
from rockframe.command.arguments import COMMON_OPTIONS, Command, CommandArgument
from rockframe.command.commands import COMMANDS

_BASH: Final = """\
_rockframe() {
    local word=${COMP_WORDS[COMP_CWORD]} words="" options=""
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="@COMMANDS@" options="--help --version"
    else
        case ${COMP_WORDS[1]} in
@CASES@
        esac
        case "${COMP_WORDS[1]} ${COMP_WORDS[COMP_CWORD - 1]}" in
@VALUES@
        esac
    fi
    case $word in -*) words=$options ;; esac
    COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o bashdefault -o default -F _rockframe rockframe
"""
"""Where it has no words, bash completes names of files, with the quotes that they need."""
_ZSH: Final = """\
_rockframe() {
    local -a commands
    commands=(
@COMMANDS@
    )
    if (( CURRENT == 2 )); then
        _describe command commands
        return
    fi
    case ${words[2]} in
@CASES@
    esac
}
compdef _rockframe rockframe
"""


def execute_completion(arguments: argparse.Namespace, answer: Answer) -> int:
    """Write the script for a shell."""
    text = script(arguments.shell)
    answer.add_text(text.removesuffix("\n"), text=text)
    return 0


def script(shell: str) -> str:
    """Write the script for a shell."""
    return {"bash": _bash, "zsh": _zsh, "fish": _fish}[shell]()


def _options(command: Command) -> list[CommandArgument]:
    values = (*command.arguments, *COMMON_OPTIONS)
    return [argument for argument in values if argument.name.startswith("-")]


def _choices(argument: CommandArgument) -> str:
    """Return the words that are the values of an argument; empty if others are possible."""
    return " ".join(argument.settings.get("choices", ()))


def _choices_without_option(command: Command) -> str:
    """Return the words that may follow a command."""
    places = (argument for argument in command.arguments if not argument.name.startswith("-"))
    return " ".join(filter(None, map(_choices, places)))


def _bash() -> str:
    cases: list[str] = []
    values: list[str] = []
    for command in COMMANDS:
        names = " ".join([*(option.name for option in _options(command)), "--help"])
        words = _choices_without_option(command)
        cases.append(f'            {command.name}) words="{words}" options="{names}" ;;')
        values += [
            f'            "{command.name} {option.name}") words="{choices}" ;;'
            for option in _options(command)
            if (choices := _choices(option))
        ]
    text = _BASH.replace("@COMMANDS@", " ".join(command.name for command in COMMANDS))
    return text.replace("@CASES@", "\n".join(cases)).replace("@VALUES@", "\n".join(values))


def _zsh() -> str:
    cases = []
    for command in COMMANDS:
        words = [
            f"'{option.name}[{_unquoted_help(option)}]{_zsh_value(option)}'"
            for option in _options(command)
        ]
        choices = _choices_without_option(command)
        places = f"'*:choice:({choices})'" if choices else "'*:file:_files'"
        cases.append(f"        {command.name}) _arguments {' '.join([*words, places])} ;;")
    names = "\n".join(f"        '{command.name}:{command.summary}'" for command in COMMANDS)
    return _ZSH.replace("@COMMANDS@", names).replace("@CASES@", "\n".join(cases))


def _zsh_value(argument: CommandArgument) -> str:
    if "action" in argument.settings:
        return ""
    if argument.is_file:
        return ":file:_files"
    return f":value:({_choices(argument)})" if _choices(argument) else ":value:"


def _fish() -> str:
    unseen = "not __fish_seen_subcommand_from " + " ".join(command.name for command in COMMANDS)
    lines = [
        f"complete -c rockframe -f -n '{unseen}' -a {command.name} -d '{command.summary}'"
        for command in COMMANDS
    ]
    for command in COMMANDS:
        seen = f"complete -c rockframe -n '__fish_seen_subcommand_from {command.name}'"
        lines += [
            f"{seen} -l {option.name.removeprefix('--')} -d '{_unquoted_help(option)}'"
            f"{_fish_value(option)}"
            for option in _options(command)
        ]
        choices = _choices_without_option(command)
        if choices:
            lines.append(f"{seen} -f -a '{choices}'")
    return "\n".join(lines) + "\n"


def _fish_value(argument: CommandArgument) -> str:
    if "action" in argument.settings:
        return ""
    return f" -x -a '{_choices(argument)}'" if _choices(argument) else " -r"


def _unquoted_help(argument: CommandArgument) -> str:
    """Return the help text of an option without characters that shells interpret."""
    return str(argument.settings.get("help", "")).translate(dict.fromkeys(map(ord, "'[]:")))
