"""Scripts by which shells complete commands, options and files, from their declarations."""

import argparse
from typing import Final

from rockframe.command.answer import Answer
from rockframe.command.arguments import COMMON_OPTIONS, Command, CommandArgument
from rockframe.command.commands import COMMANDS

_BASH: Final = """\
_rockframe() {
    local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words=""
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="@COMMANDS@ --help --version"
    else
        case $command in
@CASES@
        esac
    fi
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    if [ "$COMP_CWORD" -gt 1 ] && [ "${word#-}" = "$word" ]; then
        COMPREPLY+=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -F _rockframe rockframe
"""
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


def _choices(command: Command) -> list[str]:
    return [word for argument in command.arguments for word in argument.settings.get("choices", ())]


def _bash() -> str:
    cases = []
    for command in COMMANDS:
        words = [*_choices(command), *(option.name for option in _options(command)), "--help"]
        cases.append(f'            {command.name}) words="{" ".join(words)}" ;;')
    names = " ".join(command.name for command in COMMANDS)
    return _BASH.replace("@COMMANDS@", names).replace("@CASES@", "\n".join(cases))


def _zsh() -> str:
    cases = []
    for command in COMMANDS:
        words = [
            f"'{option.name}[{_unquoted_help(option)}]{_zsh_value(option)}'"
            for option in _options(command)
        ]
        choices = _choices(command)
        places = f"'*:choice:({' '.join(choices)})'" if choices else "'*:file:_files'"
        cases.append(f"        {command.name}) _arguments {' '.join([*words, places])} ;;")
    names = "\n".join(f"        '{command.name}:{command.summary}'" for command in COMMANDS)
    return _ZSH.replace("@COMMANDS@", names).replace("@CASES@", "\n".join(cases))


def _zsh_value(argument: CommandArgument) -> str:
    if "action" in argument.settings:
        return ""
    return ":file:_files" if argument.is_file else ":value:"


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
            f"{'' if 'action' in option.settings else ' -r'}"
            for option in _options(command)
        ]
        choices = _choices(command)
        if choices:
            lines.append(f"{seen} -f -a '{' '.join(choices)}'")
    return "\n".join(lines) + "\n"


def _unquoted_help(argument: CommandArgument) -> str:
    """Return the help text of an option without characters that shells interpret."""
    return str(argument.settings.get("help", "")).translate(dict.fromkeys(map(ord, "'[]:")))
